/**
 * Puts the sounding page behind another tab, and brings it back.
 *
 * What is recorded goes to a folder, which is the word that is given. A Chromium without a window takes
 * the focus from a page behind, but does not hide it. So what hidden pages receive is sent to this one,
 * and its tasks are stopped as a browser stops those of a page that it freezes, which is more than it
 * does to one that sounds.
 */

import { PATIENCE, keepAnalysers, open, pretendMidi, sendMidi } from "./browser.mjs";

const KEY = "KeyV"; // B4
const AWAY = 2; // s
const DRAWN = 10; // times, to see that it goes on
const NOTE = 76; // E5

/** Keeps the contexts of the sound, and counts how often the strings are drawn; runs in the page. */
function keepTimes() {
  globalThis.contexts = [];
  globalThis.drawn = 0;
  const Original = globalThis.AudioContext;
  globalThis.AudioContext = class extends Original {
    constructor(...words) {
      super(...words);
      globalThis.contexts.push(this);
    }
  };
  const { clearRect } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...box) {
    if (this.canvas.id === "yehu") globalThis.drawn += 1;
    return clearRect.apply(this, box);
  };
}

/**
 * Wait until the page is loud or quiet.
 * @param {import("playwright-core").Page} page
 * @param {boolean} isLoud
 */
function until(page, isLoud) {
  return page.waitForFunction(
    (wanted) => {
      const analyser = globalThis.analysers.at(-1);
      const samples = new Float32Array(analyser?.fftSize ?? 0);
      analyser?.getFloatTimeDomainData(samples);
      const most = samples.reduce((found, sample) => Math.max(found, Math.abs(sample)), 0);
      return wanted ? most > 0.01 : most < 0.003;
    },
    isLoud,
    { polling: 50 },
  );
}

/**
 * Wait until the strings were drawn so many times from now on.
 * @param {import("playwright-core").Page} page
 */
async function drawnAgain(page) {
  const before = await page.evaluate(() => globalThis.drawn);
  await page.waitForFunction((least) => globalThis.drawn > least, before + DRAWN);
}

/**
 * What was heard so far, s: no clock of this machine, which a busy one lets the sound fall behind.
 * @param {import("playwright-core").Page} page
 */
const heard = (page) => page.evaluate(() => globalThis.contexts.at(-1).currentTime);

/**
 * Wait for a moment of the sound, s.
 * @param {import("playwright-core").Page} page
 * @param {number} moment
 */
async function heardUntil(page, moment) {
  for (const end = Date.now() + PATIENCE; Date.now() < end && (await heard(page)) < moment;) {
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** @param {import("playwright-core").Page} page @param {boolean} isHidden */
function tellHidden(page, isHidden) {
  return page.evaluate((hidden) => {
    Object.defineProperty(document, "hidden", { value: hidden, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
  }, isHidden);
}

export const hasTabs = true;
export const isDrawnInFull = true;

export default async function (browser, url, { words: [folder] }) {
  await browser.addInitScript(keepAnalysers);
  await browser.addInitScript(keepTimes);
  await browser.addInitScript(pretendMidi);
  const { page, errors } = await open(browser, url);
  const other = await browser.newPage();
  for (const one of [page, other]) {
    const session = await browser.newCDPSession(one);
    await session.send("Emulation.setFocusEmulationEnabled", { enabled: false });
  }
  await page.bringToFront();
  const found = {};

  // A key that is held as the focus goes ends, though no event reports its release.
  await page.click("#start");
  await page.keyboard.down(KEY);
  await until(page, true);
  await other.bringToFront();
  found.hasFocus = await page.evaluate(() => document.hasFocus());
  found.keyEnded = Boolean(await until(page, false));
  await page.bringToFront();
  await page.keyboard.up(KEY);

  // A key of a MIDI keyboard is held: it sounds on behind the other tab.
  await page.click("#tab-connect");
  await page.getByRole("button", { name: "Use MIDI keyboards" }).click();
  await page.waitForFunction(() => globalThis.pretended.input.onmidimessage);
  await page.click("#tab-keep");
  await sendMidi(page, 0x90, NOTE, 90);
  await until(page, true);
  await drawnAgain(page);
  await page.getByRole("button", { name: "Record", exact: true }).click();
  const session = await browser.newCDPSession(page);
  await other.bringToFront();
  await tellHidden(page, true);
  await session.send("Page.setWebLifecycleState", { state: "frozen" });
  const left = await heard(page);
  await heardUntil(page, left + AWAY / 2); // what was on its way is drawn
  const drawn = await page.evaluate(() => globalThis.drawn);
  await heardUntil(page, left + AWAY);
  found.away = (await heard(page)) - left;
  found.drawnAway = (await page.evaluate(() => globalThis.drawn)) - drawn;
  await session.send("Page.setWebLifecycleState", { state: "active" });
  await tellHidden(page, false);
  await page.bringToFront();
  await drawnAgain(page);
  const download = page.waitForEvent("download");
  await page.locator("#panel-keep button[aria-pressed=true]").click();
  await (await download).saveAs(`${folder}/behind.wav`);
  await sendMidi(page, 0x80, NOTE, 0);
  found.noteEnded = Boolean(await until(page, false));
  return { ...found, errors };
}
