/** Uses the page of a server: there, listening, here, and while the server is away. */

import { fingersOf, keepAnalysers, open, pass } from "./browser.mjs";

const STEADY_MS = 2000;
const PATIENCE_MS = 40_000;
const LOUD = 0.01;

/** Wait until something is heard. @param {import("playwright-core").Page} page */
function heard(page) {
  return page.waitForFunction((limit) => {
    const analyser = globalThis.analysers.at(-1);
    const samples = new Float32Array(analyser?.fftSize ?? 0);
    analyser?.getFloatTimeDomainData(samples);
    return samples.some((sample) => Math.abs(sample) > limit);
  }, LOUD);
}

/** Whether a page that cannot be played is heard, and sees. @param {import("playwright-core").BrowserContext} browser */
async function listensWithoutModule(browser, url) {
  await browser.route("**/yehu.wasm", (route) => route.fulfill({ status: 404, body: "none" }));
  const { page } = await open(browser, url);
  await page.click("#start");
  await heard(page);
  await page.click("#tab-see");
  await page.waitForFunction(() => /cents/.test(document.querySelector("#tuner").ariaLabel));
  await page.close();
  await browser.unroute("**/yehu.wasm");
  return true;
}

/**
 * Press Start while the line to the server is still being made.
 * @param {import("playwright-core").BrowserContext} browser
 * What the page says, and once there is a line; and how many sounds it has begun.
 */
async function startsEarly(browser, url) {
  const page = await browser.newPage();
  let connect = () => {};
  const mayConnect = new Promise((resolve) => (connect = () => resolve(undefined)));
  await page.routeWebSocket(/\/socket/, async (socket) => {
    await mayConnect;
    socket.connectToServer();
  });
  await page.addInitScript(() => {
    globalThis.begun = 0;
    globalThis.AudioContext = class extends globalThis.AudioContext {
      constructor(...words) {
        super(...words);
        globalThis.begun += 1;
      }
    };
  });
  await page.goto(url);
  await page.waitForSelector("#play #ways input");
  await page.click("#start");
  const status = page.locator("#status");
  const before = await status.textContent();
  connect();
  await page.waitForSelector("#status[data-state=on]", { state: "attached" });
  await page.click("#tab-connect");
  const panel = page.locator("#panel-connect");
  await page.waitForFunction(() =>
    document.querySelector("#panel-connect").innerText.includes("Hz"),
  );
  const after = await panel.textContent();
  const begun = await page.evaluate(() => globalThis.begun);
  await page.close();
  return { before, after, begun };
}

/**
 * Wait until the server's note is heard, and until it has gone on for a while without another gap: a
 * busy machine has some, until enough of the sound waits.
 * @param {import("playwright-core").Page} page
 * @returns {Promise<boolean>} whether it came to that
 */
async function isHeardSteadily(page) {
  await heard(page);
  const panel = page.locator("#panel-connect");
  const gaps = async () => /last minute: (\d+)/.exec(await panel.textContent())[1];
  let [before, since] = [await gaps(), Date.now()];
  for (const end = Date.now() + PATIENCE_MS; Date.now() < end;) {
    await pass(page, 100);
    const now = await gaps();
    if (now !== before) [before, since] = [now, Date.now()];
    else if (Date.now() - since > STEADY_MS) return true;
  }
  return false;
}

export default async function (browser, url, { reach }) {
  await browser.addInitScript(keepAnalysers);
  await reach("before");
  const { page, errors } = await open(browser, url);
  await page.locator("#ways output").getByText("33").waitFor(); // the server's vibrato, before a touch
  const touch = await fingersOf(page);
  const found = {};
  const status = () => page.getAttribute("#status", "data-state");
  found.early = await startsEarly(browser, url);
  await page.bringToFront();
  await page.click("#tab-connect");
  await page.waitForSelector("#way-there[aria-pressed], #way-listen[aria-pressed]");
  found.first = await page.locator('.choice [id^="way-"][aria-pressed=true]').getAttribute("id");
  found.reachable = await reach("opened");

  await page.click("#way-there");
  await page.waitForSelector("#status[data-state=on]", { state: "attached" });
  found.there = await status();
  found.lack = await page.locator("#panel-keep").textContent();
  const board = await page.locator("#fingerboard").boundingBox();
  const finger = { x: board.x + board.width / 2, y: board.y + board.height / 2, id: 1 };
  await touch("touchStart", [finger]);
  await reach("holds");
  await touch("touchEnd", []);
  await reach("let go");
  await page.click("#tab-all");
  await reach("watches");
  found.shown = await page.evaluate(async () => {
    const rows = [...document.querySelectorAll("#panel-all .parameter")];
    const row = rows.find((one) => one.querySelector("code").textContent === "/playing/pressure");
    const number = row.querySelector("input[type=number]");
    for (let i = 0; i < 100 && number.value !== "0.62"; i++) {
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    return number.value;
  });

  await page.click("#tab-connect");
  await page.click("#way-listen");
  await page.waitForFunction(() =>
    /listen|heard/i.test(document.querySelector("#panel-connect").textContent),
  );
  await reach("listens");
  found.listensWithoutModule = await listensWithoutModule(browser, url);
  found.isSteady = await isHeardSteadily(page);
  found.listening = await status();
  found.panel = await page.locator("#panel-connect").textContent();
  await reach("has listened");

  await page.waitForSelector("#way-here:not([disabled])", { timeout: 120000 });
  await page.click("#way-here");
  await page.waitForFunction(() =>
    /AudioWorklet/.test(document.querySelector("#panel-connect").textContent),
  );
  await touch("touchStart", [finger]);
  await reach("plays here");
  await touch("touchEnd", []);
  await reach("let go here");

  await page.click("#way-there");
  found.errors = [...errors];
  await reach("stop the server");
  await page.waitForFunction(() =>
    /does not answer/.test(document.querySelector("#status").textContent),
  );
  await reach("start the server");
  await page.waitForSelector("#status[data-state=on]", { state: "attached" });
  await touch("touchStart", [finger]);
  await reach("holds again");
  await touch("touchEnd", []);
  return found;
}
