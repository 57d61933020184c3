/** A newcomer comes to an easy tune, plays it with a mistake, and sees how it went; prints what was seen. */

import { drawn, open, requested, commands } from "./browser.mjs";

const SIZES = [
  [320, 568],
  [844, 390],
  [768, 1024],
  [1920, 1080],
];
const KEYS = "ZSXDCFVBHNJM";
const FIRST = 65;

/** Boxes that lie over each other; runs in the page. */
function overlaps() {
  const parts = ["header", ".bar:not([hidden])", "#stage", "#ways", "#more:not([hidden])"]
    .map((name) => [name, document.querySelector(name)])
    .filter(([, element]) => element?.checkVisibility())
    .map(([name, element]) => [name, element.getBoundingClientRect()]);
  const found = [];
  parts.forEach(([one, a], i) => {
    for (const [other, b] of parts.slice(i + 1)) {
      const isOver =
        Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
        Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
      if (isOver) found.push(`${one} ${other}`);
    }
    if (a.bottom > innerHeight + 1 || a.right > innerWidth + 1) found.push(`${one} cut`);
  });
  return found;
}

export default async function (browser, url) {
  const found = { overlaps: {}, boards: {} };
  const { page, errors } = await open(browser, url);
  const see = async (/** @type {string} */ what) => {
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      await drawn(page);
      found.overlaps[`${what} ${width}x${height}`] = await page.evaluate(overlaps);
      const stage = await page.locator("#stage").boundingBox();
      found.boards[`${what} ${width}x${height}`] = (stage.width * stage.height) / (width * height);
    }
  };
  let actions = 0;
  const act = async (/** @type {Promise<unknown>} */ done) => {
    actions += 1;
    await done;
  };
  await see("guide");
  await page.setViewportSize({ width: 390, height: 844 });
  await act(page.touchscreen.tap(200, 450)); // a string
  await act(page.click("#skip"));
  await act(page.click("#tab-tunes"));
  await act(page.locator("#panel-tunes .tune button").nth(1).click());
  await page.waitForSelector("#lesson:not([hidden])");
  found.actions = actions;
  found.covered = await page.locator("#more").isVisible();
  await see("lesson");

  const said = () => page.textContent("#said");
  const press = (/** @type {number} */ pitch) => page.keyboard.press(`Key${KEYS[pitch - FIRST]}`);
  const notes = await page.evaluate(async () => {
    const { default: examples } = await import("/examples.js");
    const { notesOf } = await import("/hands/fingering.js");
    return notesOf(examples.twinkle).map(({ pitch }) => pitch);
  });
  await press(notes[0] + 2); // wrong
  found.answered = await said();
  for (const pitch of notes) await press(pitch);
  found.result = await said();
  await see("result");
  await page.click("#again");
  found.again = await page.locator("#score").isVisible();
  await page.click("#stop");
  found.stopped = await page.locator("#lesson").isHidden();

  await page.setViewportSize({ width: 1440, height: 900 });
  await page.click("#tab-tunes");
  await commands(page);
  await page.locator("#panel-tunes .tune button").first().click();
  await requested(page, "BEGIN");
  found.heard = (await commands(page)).filter(([kind]) => kind === "BEGIN").length;
  // The strip of notes is drawn, and goes on.
  const picture = () => page.locator("#score").evaluate((canvas) => canvas.toDataURL());
  const one = await picture();
  for (let tries = 0; tries < 100 && !found.goesOn; tries++) {
    await drawn(page);
    found.goesOn = one !== (await picture());
  }
  await page.click("#stop");
  found.errors = errors;
  return found;
}
