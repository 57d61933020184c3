/**
 * Plays the page itself, as a static site: loud and soft by touch, mouse and pen; at rest; and without
 * a network.
 */

import { fingersOf, keepAnalysers, open, pass } from "./browser.mjs";

const SHARES = [0.03, 0.35, 0.65, 0.97];
const PITCHES = [67, 74, 81];
const SETTLES_MS = 800;
const ASLEEP_MS = 17_000; // its last sound dies away, it falls asleep, and then its device

/** The level of what is heard for some time, dBFS; runs in the page. */
async function level() {
  const analyser = globalThis.analysers.at(-1);
  const samples = new Float32Array(analyser.fftSize);
  let power = 0;
  for (let n = 0; n < 8; n++) {
    analyser.getFloatTimeDomainData(samples);
    power += samples.reduce((sum, sample) => sum + sample ** 2, 0) / samples.length / 8;
    await new Promise((resolve) => setTimeout(resolve, 80));
  }
  return 10 * Math.log10(power);
}

/** @param {import("playwright-core").Page} page */
async function dynamics(page) {
  const touch = await fingersOf(page);
  const pen = await page.context().newCDPSession(page);
  const { x, y, width, height } = await page.locator("#fingerboard").boundingBox();
  /** @param {number} pitch @param {number} share */
  const at = (pitch, share) => ({
    x: x + ((pitch - 65 + 0.6) / 25.2) * width,
    y: y + (1 - share) * height,
  });
  const byPen = (/** @type {string} */ type, /** @type {object} */ place, force = 0) =>
    pen.send("Input.dispatchMouseEvent", {
      type, ...place, force, pointerType: "pen", button: "left", buttons: 1, clickCount: 1,
    }); // prettier-ignore
  const ways = {
    touch: {
      down: (pitch, share) => touch("touchStart", [{ ...at(pitch, share), id: 1 }]),
      up: () => touch("touchEnd", []),
    },
    mouse: {
      down: async (pitch, share) => {
        await page.mouse.move(at(pitch, share).x, at(pitch, share).y);
        await page.mouse.down();
      },
      up: () => page.mouse.up(),
    },
    pen: {
      down: (pitch, share) => byPen("mousePressed", at(pitch, 0.5), share),
      up: (pitch) => byPen("mouseReleased", at(pitch, 0.5)),
    },
  };
  const found = {};
  for (const [name, { down, up }] of Object.entries(ways)) {
    found[name] = {};
    for (const pitch of PITCHES) {
      found[name][pitch] = [];
      for (const share of SHARES) {
        await down(pitch, share);
        await pass(page, SETTLES_MS);
        found[name][pitch].push(await page.evaluate(level));
        await up(pitch);
        await pass(page, 200);
      }
    }
  }
  return found;
}

/** The processor time of the whole browser over some seconds, as a share of one core. */
async function load(browser, seconds) {
  const session = await browser.browser().newBrowserCDPSession();
  const total = async () =>
    (await session.send("SystemInfo.getProcessInfo")).processInfo
      .map(({ cpuTime }) => cpuTime)
      .reduce((sum, time) => sum + time);
  const before = await total();
  await new Promise((resolve) => setTimeout(resolve, 1e3 * seconds));
  return ((await total()) - before) / seconds;
}

export const isDrawnInFull = true;

export default async function (browser, url) {
  await browser.addInitScript(keepAnalysers);
  const { page, errors } = await open(browser, url);
  await pass(page, 1500);
  const found = {};
  const board = await page.locator("#fingerboard").boundingBox();
  await page.mouse.move(board.x + board.width / 2, board.y + board.height / 3);
  // From the press of a mouse to the first sample that is heard, by the page's own clock.
  const heard = page.evaluate(
    () =>
      new Promise((resolve) => {
        let began = NaN;
        const check = () => {
          const samples = new Float32Array(1024);
          globalThis.analysers.at(-1)?.getFloatTimeDomainData(samples);
          if (samples.some((sample) => Math.abs(sample) > 1e-3)) resolve(performance.now() - began);
          else setTimeout(check, 2);
        };
        addEventListener("pointerdown", (event) => (began = event.timeStamp), { capture: true });
        check();
      }),
  );
  found.loaded = [];
  const isOfNoUse = (request) => request.serviceWorker() || request.url().endsWith("/icon.svg");
  const asked = (request) => isOfNoUse(request) || found.loaded.push(request.url());
  page.on("request", asked);
  await page.mouse.down();
  found.firstMs = await heard;
  page.off("request", asked);
  await pass(page, 500);
  found.playing = await load(browser, 3);
  await page.mouse.up();
  found.dynamics = await dynamics(page);

  await page.evaluate(() => {
    globalThis.drawn = 0;
    const { clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      globalThis.drawn += 1;
      return clearRect.apply(this, box);
    };
  });
  await pass(page, ASLEEP_MS);
  await page.evaluate(() => (globalThis.drawn = 0));
  found.resting = await load(browser, 4);
  found.drawnAtRest = await page.evaluate(() => globalThis.drawn);
  found.state = await page.evaluate(() => globalThis.analysers.at(-1).context.state);
  await page.keyboard.down("KeyV");
  await pass(page, 1000);
  found.awake = await page.evaluate(level);
  await page.keyboard.up("KeyV");

  await page.evaluate(() => navigator.serviceWorker.ready);
  await page.reload();
  await browser.setOffline(true);
  const { page: alone, errors: others } = await open(browser, url);
  await alone.click("#start");
  await alone.keyboard.down("KeyV");
  await pass(alone, 1500);
  found.offline = await alone.evaluate(level);
  found.language = await alone.evaluate(
    async () => (await (await fetch("/texts/zh.json")).json()).title,
  );
  return { ...found, errors: [...errors, ...others] };
}
