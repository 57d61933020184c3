/** Pages that play several parts of one server. */

import { fingersOf, open, pass } from "./browser.mjs";

/**
 * What the page shows of its part.
 * @param {import("playwright-core").Page} page
 */
async function shown(page) {
  await page.waitForSelector("#status[data-state=on]", { state: "attached" });
  await pass(page, 200);
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
 * Touch the fingerboard while the test checks who plays.
 * @param {import("playwright-core").Page} page
 * @param {string} step
 * @param {(step: string) => Promise<void>} reach
 */
async function play(page, step, reach) {
  const touch = await fingersOf(page);
  const board = await page.locator("#fingerboard").boundingBox();
  await touch("touchStart", [{ x: board.x + board.width / 2, y: board.y + 20, id: 1 }]);
  await reach(step);
  await touch("touchEnd", []);
  await reach("let go");
}

export default async function (browser, url, { reach }) {
  const { page, errors } = await open(browser, `${url}?part=2`);
  const found = {};
  await page.click("#tab-connect");
  await page.waitForSelector("#way-there");
  await page.click("#way-there");
  found.second = await shown(page);
  found.about = await page.locator("#panel-connect").textContent();
  await play(page, "holds in 2", reach);

  await page.click("#tab-sound");
  await page.locator("#room input[type=range]").nth(1).focus();
  await page.keyboard.press("End");
  await reach("the room is larger");

  await Promise.all([page.waitForURL(/part=3/), page.selectOption("#part", "3")]);
  found.third = await shown(page);
  await play(page, "holds in 3", reach);

  await page.goto(`${url}?part=9`);
  found.none = await shown(page);
  await play(page, "holds in 1", reach);
  await page.setViewportSize({ width: 360, height: 740 });
  found.narrow = await page.evaluate(() => ({
    isThere: document.querySelector("#part").checkVisibility(),
    over: document.documentElement.scrollWidth - innerWidth,
  }));
  found.errors = errors;
  return found;
}
