/**
 * Counts how often pictures are drawn, with and without the request for little motion; and drags in the
 * diagram on a narrow phone.
 */

import { READY, SIZES, commands, fingersOf, open, pass } from "./browser.mjs";

const SECOND = 1000;

/** Counts the drawings of each canvas by its id, and what they draw; runs in the page. */
function countDrawings() {
  globalThis.drawn = {};
  const { clearRect } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...box) {
    globalThis.drawn[this.canvas.id] = (globalThis.drawn[this.canvas.id] ?? 0) + 1;
    return clearRect.apply(this, box);
  };
}

/**
 * Drawings in a second, by canvas, while a note sounds.
 * @param {import("playwright-core").Page} page
 */
async function perSecond(page) {
  await page.evaluate(() => (globalThis.drawn = {}));
  await pass(page, SECOND);
  return page.evaluate(() => globalThis.drawn);
}

/**
 * The longest transition or animation of any element, in seconds.
 * @param {import("playwright-core").Page} page
 */
function longestTransition(page) {
  return page.evaluate(() => {
    const seconds = (text) => Math.max(...text.split(",").map(Number.parseFloat));
    const all = [...document.querySelectorAll("*")].flatMap((element) =>
      ["", "::before", "::after"].map((part) => {
        const { transitionDuration, animationDuration } = getComputedStyle(element, part);
        return Math.max(seconds(transitionDuration), seconds(animationDuration));
      }),
    );
    return Math.max(...all.filter(Number.isFinite));
  });
}

/**
 * What each canvas shows, by its id.
 * @param {import("playwright-core").Page} page
 */
function shown(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll("canvas")].map((canvas) => [canvas.id, canvas.toDataURL()]),
  );
}

/** @param {import("playwright-core").Page} page */
const pressed = (page) => page.locator('[id^="view-"][aria-pressed=true]').allTextContents();

/**
 * Whether the frog of the bow is seen to move, which is beside the strings.
 * @param {import("playwright-core").Page} page
 */
async function bowMoves(page) {
  const picture = () =>
    page.locator("#yehu").evaluate((canvas) => {
      const [x, width] = [0.68, 0.08].map((share) => Math.round(share * canvas.width));
      const part = document.createElement("canvas");
      Object.assign(part, { width, height: Math.round(0.12 * canvas.height) });
      part.getContext("2d").drawImage(canvas, -x, 0);
      return part.toDataURL();
    });
  const first = await picture();
  await pass(page, SECOND);
  return first !== (await picture());
}

/**
 * @param {import("playwright-core").BrowserContext} browser
 * @param {string} url
 * @param {"reduce" | "no-preference"} reducedMotion
 */
async function visit(browser, url, reducedMotion) {
  const { page, errors } = await open(browser, url);
  await page.emulateMedia({ reducedMotion });
  await page.reload();
  await page.waitForSelector(READY);
  if (await page.locator("#more").isHidden()) await page.click("#tab-see");
  const found = { pressed: await pressed(page), transition: await longestTransition(page) };
  const silent = new Map(await shown(page));
  await page.keyboard.down("KeyC");
  await pass(page, 900);
  const sounding = await shown(page);
  found.changed = sounding.filter(([id, image]) => image !== silent.get(id)).map(([id]) => id);
  found.drawn = await perSecond(page);
  found.bowMoves = await bowMoves(page);
  await page.click("#view-slowed");
  found.clicked = { pressed: await pressed(page), drawn: await perSecond(page) };
  await page.keyboard.up("KeyC");
  await page.reload();
  await page.waitForSelector(READY);
  found.again = await pressed(page);
  await page.close();
  return { ...found, errors };
}

/**
 * Drag in the diagram, with and without a note.
 * @param {import("playwright-core").BrowserContext} browser
 * @param {string} url
 */
async function drag(browser, url) {
  const { page, errors } = await open(browser, url);
  await page.setViewportSize(SIZES.phone);
  const touch = await fingersOf(page);
  const found = { errors };
  await page.click("#start");
  await page.waitForFunction(() => globalThis.imitation);
  if (await page.locator("#more").isHidden()) await page.click("#tab-see");
  await page.locator("#schelleng").scrollIntoViewIfNeeded();
  for (const name of ["silent", "sounding"]) {
    if (name === "sounding") await page.keyboard.down("KeyC");
    await pass(page, 500);
    await commands(page);
    await page.evaluate(() => {
      globalThis.taken = false;
      const take = () => (globalThis.taken = true);
      document.querySelector("#schelleng").addEventListener("pointercancel", take, { once: true });
    });
    const { x, y, width, height } = await page.locator("#schelleng").boundingBox();
    const at = (/** @type {number} */ share) => [
      { x: x + width * (0.3 + share / 2), y: y + height * (0.25 + share / 2), id: 1 },
    ];
    await touch("touchStart", at(0));
    for (let step = 1; step <= 10; step++) {
      await touch("touchMove", at(step / 10));
      await pass(page, 20);
    }
    await touch("touchEnd", []);
    await pass(page, 300);
    found[name] = {
      taken: await page.evaluate(() => globalThis.taken), // by the browser, to scroll
      commands: await commands(page),
      room: { width, height },
    };
  }
  await page.keyboard.up("KeyC");
  return found;
}

export const isDrawnInFull = true;

export default async function (browser, url) {
  await browser.addInitScript(countDrawings);
  const calm = await visit(browser, url, "reduce"); // first: nothing is remembered yet
  const lively = await visit(browser, url, "no-preference");
  const dragged = await drag(browser, url);
  const errors = [calm, lively, dragged].flatMap((each) => each.errors);
  return { calm, lively, drag: dragged, errors };
}
