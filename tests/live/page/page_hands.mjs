/** Plays the page with fingers, mouse and keys; prints the commands that followed. */

import { commands, fingersOf, held, open, pass } from "./browser.mjs";

/** @param {import("playwright-core").Locator} locator */
async function boxOf(locator) {
  const box = await locator.boundingBox();
  if (!box) throw new Error("not shown");
  return box;
}

export default async function (browser, url) {
  const { page, errors } = await open(browser, url);
  const touch = await fingersOf(page);
  const board = await boxOf(page.locator("#fingerboard"));
  const bow = await boxOf(page.locator("#bow"));
  /** @param {number} pitch */
  const placeOf = (pitch) => board.x + ((pitch - 65 + 0.6) / 25.2) * board.width;
  const middle = board.y + board.height / 2;
  const found = {};
  await page.click("#start");
  await page.waitForFunction(() => globalThis.imitation);
  await commands(page);

  const ten = Array.from({ length: 10 }, (_, id) => ({ x: placeOf(67 + 2 * id), y: middle, id }));
  /** @param {number} count of fingers that are down */
  const press = async (count) => {
    for (let n = 1; n <= count; n++) await touch("touchStart", ten.slice(0, n));
  };
  await press(10);
  found.tenDown = { held: await held(page), commands: await commands(page) };
  for (let n = 9; n >= 1; n--) await touch("touchEnd", ten.slice(0, n));
  await touch("touchEnd", []);
  found.tenUp = { held: await held(page), commands: await commands(page) };

  await press(10);
  await touch("touchCancel", []);
  found.cancelled = { held: await held(page), commands: await commands(page) };

  await press(10);
  await page.evaluate(() => window.dispatchEvent(new Event("blur")));
  found.left = { held: await held(page) };
  await touch("touchCancel", []);
  await press(10);
  await touch("touchEnd", []);
  await press(3);
  await page.evaluate(() => {
    Object.defineProperty(document, "hidden", { value: true, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
    delete document.hidden;
  });
  found.hidden = { held: await held(page) };
  await touch("touchEnd", []);
  await press(10);
  await touch("touchEnd", []);
  found.atOnce = { held: await held(page) };
  await commands(page);

  // A finger that slides, with a semitone's steps, and one that lands beside a note.
  await touch("touchStart", [{ x: placeOf(69.2), y: middle, id: 0 }]);
  for (let step = 1; step <= 8; step++) {
    await touch("touchMove", [{ x: placeOf(69.2 + step / 4), y: middle, id: 0 }]);
  }
  await touch("touchEnd", []);
  found.slid = await commands(page);

  await touch("touchStart", [{ x: placeOf(72), y: middle, id: 0 }]);
  for (const share of [0.02, 0.98]) {
    await touch("touchMove", [{ x: placeOf(72), y: board.y + share * board.height, id: 0 }]);
  }
  await touch("touchEnd", []);
  await pass(page, 800);
  found.swelled = await commands(page);

  // The bow, drawn across the strings and back while a finger stops the string.
  /** @param {number} share */
  const at = (share) => ({ x: bow.x + bow.width * 0.3, y: bow.y + bow.height * share, id: 5 });
  const stopping = { x: placeOf(74), y: middle, id: 6 };
  await touch("touchStart", [at(0.2)]);
  await touch("touchStart", [at(0.2), stopping]);
  for (let step = 0; step <= 10; step++) {
    await touch("touchMove", [at(0.2 + step * 0.03), stopping]);
    await pass(page, 20);
  }
  found.drawnForth = await commands(page);
  for (let step = 10; step >= 0; step--) {
    await touch("touchMove", [at(0.2 + step * 0.03), stopping]);
    await pass(page, 20);
  }
  found.drawnBack = await commands(page);
  await pass(page, 250);
  found.rested = await commands(page);
  await touch("touchEnd", [stopping]);
  await touch("touchEnd", []);
  found.lifted = { held: await held(page), commands: await commands(page) };

  // Without assist the fingerboard only stops the string.
  await page.locator("#ways input[role=switch]").first().uncheck();
  await commands(page);
  await touch("touchStart", [{ x: placeOf(76), y: middle, id: 1 }]);
  await touch("touchEnd", []);
  found.withoutAssist = await commands(page);
  for (const [name, height] of [
    ["light", 0.1],
    ["firm", 0.9],
  ]) {
    await page.mouse.move(bow.x + bow.width * height, bow.y + bow.height * 0.3);
    await page.mouse.down();
    await page.mouse.up();
    found[name] = await commands(page);
  }
  await page.locator("#ways input[role=switch]").first().check();

  // The computer's keyboard.
  await page.locator("#fingerboard").focus();
  await commands(page);
  for (const key of ["KeyZ", "KeyV", "KeyQ"]) await page.keyboard.down(key);
  for (const key of ["KeyQ", "KeyV", "KeyZ"]) await page.keyboard.up(key);
  found.keys = { held: await held(page), commands: await commands(page) };
  for (const key of ["KeyZ", "KeyX", "KeyC"]) await page.keyboard.down(key);
  await page.evaluate(() => window.dispatchEvent(new Event("blur")));
  found.keysLeft = { held: await held(page) };
  for (const key of ["KeyZ", "KeyX", "KeyC"]) await page.keyboard.up(key);
  await page.keyboard.press("Equal");
  await commands(page);
  await page.keyboard.press("KeyZ");
  found.octave = await commands(page);
  await page.keyboard.press("Minus");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.down("Space");
  await page.keyboard.up("Space");
  found.arrows = await commands(page);
  await page.locator("#bow").focus();
  await page.keyboard.down("ArrowLeft");
  await page.keyboard.up("ArrowLeft");
  found.bowKeys = await commands(page);
  await page.click("#tab-all");
  await page.locator("#panel-all input[type=search]").fill("zxcv");
  found.writing = await commands(page);
  await page.keyboard.press("Escape");
  found.errors = errors;
  return found;
}
