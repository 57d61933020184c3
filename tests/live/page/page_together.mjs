/** Two pages of one server, which both sound by themselves: what is played in one sounds in the other. */

import { fingersOf, keepAnalysers, open } from "./browser.mjs";

const QUIET = 0.003;
const LOUD = 0.02;

/**
 * Wait until a page is heard, or silent; return its pitch in Hz, by the spectrum's greatest value.
 * @param {import("playwright-core").Page} page
 * @param {"loud" | "quiet"} what
 */
async function until(page, what) {
  await page.waitForFunction(
    ([isLoud, limit]) => {
      const analyser = globalThis.analysers.at(-1);
      const samples = new Float32Array(analyser.fftSize);
      analyser.getFloatTimeDomainData(samples);
      const most = samples.reduce((found, sample) => Math.max(found, Math.abs(sample)), 0);
      return isLoud ? most > limit : most < limit;
    },
    what === "loud" ? [true, LOUD] : [false, QUIET],
    { timeout: 20_000 },
  );
}

/**
 * The note that the page's own instrument has, as its tuner says it.
 * @param {import("playwright-core").Page} page
 */
async function noteOf(page) {
  await page.waitForFunction(() => /cents/.test(document.querySelector("#tuner").ariaLabel));
  return page.evaluate(() => /Tuner: (\S+),/.exec(document.querySelector("#tuner").ariaLabel)[1]);
}

/**
 * A finger on a note of the fingerboard.
 * @param {import("playwright-core").Page} page
 * @param {number} pitch
 */
async function fingerAt(page, pitch) {
  const box = await page.locator("#fingerboard").boundingBox();
  return { x: box.x + ((pitch - 65 + 0.6) / 25.2) * box.width, y: box.y + box.height / 2, id: 1 };
}

export default async function (browser, url, { reach }) {
  await browser.addInitScript(keepAnalysers);
  const players = [await open(browser, url), await open(browser, url)];
  for (const { page } of players) {
    await page.click("#tab-connect");
    await page.waitForSelector("#way-here:not([disabled])", { timeout: 100_000 });
    await page.click("#way-here");
    await page.waitForFunction(() =>
      /AudioWorklet/.test(document.querySelector("#panel-connect").textContent),
    );
    await page.click("#tab-see");
  }
  const notes = [];
  for (const [own, pitch] of [
    [0, 71],
    [1, 76],
  ]) {
    const touch = await fingersOf(players[own].page);
    await touch("touchStart", [await fingerAt(players[own].page, pitch)]);
    for (const { page } of players) await until(page, "loud");
    notes.push([await noteOf(players[0].page), await noteOf(players[1].page)]);
    await reach(`holds ${pitch}`);
    await touch("touchEnd", []);
    for (const { page } of players) await until(page, "quiet");
    await reach(`let go ${pitch}`);
  }

  // A page that goes leaves no note behind, in the other page and in the server.
  const touch = await fingersOf(players[1].page);
  await touch("touchStart", [await fingerAt(players[1].page, 69)]);
  await until(players[0].page, "loud");
  await reach("holds 69");
  await players[1].page.close();
  await until(players[0].page, "quiet");
  await reach("let go 69");
  return { notes, errors: players.flatMap(({ errors }) => errors) };
}
