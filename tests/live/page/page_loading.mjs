/** Opens the page while a server prepares the instrument, and where there is none; prints what it says. */

import { READY, held, open, pass } from "./browser.mjs";

const WASM = "**/yehu.wasm";
const TEXT = "text/plain; charset=utf-8";
const KEY = "KeyV";

/** @param {import("playwright-core").Page} page */
async function notice(page) {
  const element = page.locator("#notice");
  return (await element.isVisible()) ? element.textContent() : null;
}

/** Whether a key begins a note. @param {import("playwright-core").Page} page */
async function plays(page) {
  await page.click("#start");
  await page.waitForFunction(() => globalThis.imitation);
  await page.keyboard.down(KEY);
  await pass(page, 300);
  const isHeld = (await held(page)) === 1;
  await page.keyboard.up(KEY);
  return isHeld;
}

/** How often the strings are drawn in a second. @param {import("playwright-core").Page} page */
const drawings = (page) =>
  page.evaluate(async () => {
    let count = 0;
    const { clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      if (this.canvas.id === "yehu") count += 1;
      return clearRect.apply(this, box);
    };
    await new Promise((resolve) => setTimeout(resolve, 1000));
    return count;
  });

export default async function (browser, url) {
  const found = {};
  let answers = 0;
  await browser.route(WASM, (route) => {
    answers += 1;
    if (answers > 2) return route.continue();
    return route.fulfill({ status: 503, headers: { "Retry-After": "1" }, body: "not built yet" });
  });
  const waiting = await browser.newPage();
  await waiting.goto(url);
  await waiting.waitForSelector("#notice:not([hidden])");
  found.preparing = await notice(waiting);
  await waiting.waitForSelector(READY);
  found.answers = answers;
  found.ready = { notice: await notice(waiting), plays: await plays(waiting) };
  await waiting.close();
  await browser.unroute(WASM);

  await browser.route(WASM, (route) =>
    route.fulfill({ status: 404, contentType: TEXT, body: "there is no wasm-ld here\n" }),
  );
  const { page: without } = await open(browser, url);
  found.lacking = await notice(without);
  await without.click("#language");
  await without.waitForFunction(() => document.documentElement.lang === "zh-Hans");
  found.lackingInChinese = await notice(without);
  found.without = { plays: await plays(without), drawings: await drawings(without) };
  return found;
}
