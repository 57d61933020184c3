/** Pages that play several parts of one server. */

import { createInterface } from "node:readline";

import { fingersOf, open, run } from "./browser.mjs";

const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();

/** Tell the test where the scenario is, and wait until it answers. @param {string} step */
async function reach(step) {
  console.error(step);
  return (await lines.next()).value;
}

/**
 * What the page shows of its part.
 * @param {import("playwright-core").Page} page
 */
async function shown(page) {
  await page.waitForSelector("#status[data-state=on]", { state: "attached" });
  await page.waitForTimeout(200);
  return page.evaluate(() => {
    const select = document.querySelector("#part");
    return {
      isThere: select.checkVisibility(),
      chosen: select.value,
      options: [...select.options].map(({ text }) => text),
      title: document.title,
      address: location.search,
    };
  });
}

/**
 * Touch the fingerboard while the test looks who plays.
 * @param {import("playwright-core").Page} page
 * @param {string} step
 */
async function play(page, step) {
  const touch = await fingersOf(page);
  const board = await page.locator("#fingerboard").boundingBox();
  await touch("touchStart", [{ x: board.x + board.width / 2, y: board.y + 20, id: 1 }]);
  await reach(step);
  await touch("touchEnd", []);
  await reach("let go");
}

await run(async (browser, url) => {
  const { page, errors } = await open(browser, `${url}?part=2`);
  const found = {};
  await page.click("#tab-connect");
  await page.waitForSelector("#way-there");
  await page.click("#way-there");
  found.second = await shown(page);
  found.about = await page.locator("#panel-connect").textContent();
  await play(page, "holds in 2");

  await page.click("#tab-sound");
  await page.locator("#room input[type=range]").nth(1).focus();
  await page.keyboard.press("End");
  await reach("the room is larger");

  await Promise.all([page.waitForURL(/part=3/), page.selectOption("#part", "3")]);
  found.third = await shown(page);
  await play(page, "holds in 3");

  await page.goto(`${url}?part=9`);
  found.none = await shown(page);
  await play(page, "holds in 1");
  await page.setViewportSize({ width: 360, height: 740 });
  found.narrow = await page.evaluate(() => ({
    isThere: document.querySelector("#part").checkVisibility(),
    over: document.documentElement.scrollWidth - innerWidth,
  }));
  found.errors = errors;
  process.stdin.destroy(); // else Node waits for more
  return found;
});
