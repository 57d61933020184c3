/** Chooses to sound here, of the page of a server that others have set. */

import { fingersOf, open, pass } from "./browser.mjs";

/** The value that the page shows. @param {import("playwright-core").Page} page @param {string} address */
async function shown(page, address) {
  await page.click("#tab-all");
  await pass(page, 1000); // it is refreshed a few times a second
  const value = await page.evaluate((address) => {
    const rows = [...document.querySelectorAll("#panel-all .parameter")];
    const row = rows.find((one) => one.querySelector("code").textContent === address);
    return row.querySelector("input[type=number]").value;
  }, address);
  await page.click("#tab-connect");
  return value;
}

export default async function (browser, url, { reach }) {
  const { page, errors } = await open(browser, url);
  const touch = await fingersOf(page);
  await page.click("#tab-connect");
  await page.waitForSelector("#way-here:not([disabled])", { timeout: 120000 });
  const found = {};
  const board = await page.locator("#fingerboard").boundingBox();
  const finger = { x: board.x + board.width / 2, y: board.y + board.height / 2, id: 1 };
  /** @param {string} when @param {string} way */
  const here = async (when, way = "here") => {
    await reach(`before ${when}`);
    await pass(page, 100); // a page sees what others set some milliseconds later
    await page.click(`#way-${way}`);
    await page.waitForFunction(
      (where) => document.querySelector("#panel-connect").textContent.includes(where),
      way === "here" ? "AudioWorklet" : "the server’s sound",
    );
    await pass(page, 500);
    await reach(`chosen ${when}`);
    found[when] = await shown(page, "/playing/bow_position");
    await touch("touchStart", [finger]);
    await reach(`plays ${when}`);
    await touch("touchEnd", []);
    await reach(`played ${when}`);
  };
  await here("at first");
  await here("there", "there");
  await here("again");
  await page.reload(); // it remembers where, and that the panel is open
  await page.waitForSelector("#way-here[aria-pressed=true]", { timeout: 120000 });
  await here("after a reload");
  found.errors = errors;
  return found;
}
