/** Teaches the page's MIDI keyboard what its knobs move, by keys alone; prints what followed. */

import { readFileSync } from "node:fs";
import { READY, open, pretendMidi, sendMidi, commands } from "./browser.mjs";

const KNOB = 0xb0;
const WHEEL = 0xe0;
const TOUCH = 0xd0;

/**
 * Commands that write parameters: [row, value].
 * @param {import("playwright-core").Page} page
 */
async function written(page) {
  const all = await commands(page);
  return all.filter(([kind]) => kind === "WRITE").map(([, row, value]) => [row, value]);
}

/**
 * Save the file that the page offers.
 * @param {import("playwright-core").Page} page
 */
async function saved(page) {
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save as a file" }).press("Enter");
  const offered = await download;
  return { name: offered.suggestedFilename(), text: readFileSync(await offered.path(), "utf8") };
}

export default async function (browser, url) {
  await browser.addInitScript(pretendMidi);
  const { page, errors } = await open(browser, url);
  const found = {};
  const panel = page.locator("#panel-connect");
  const learn = panel.getByRole("button", { name: "Learn", exact: true });
  const list = () => panel.locator(".binds > li > span:first-child").allTextContents();
  const word = () => panel.locator("section:has(.binds) p[role=status]").textContent();

  // A parameter is chosen, the keyboard is asked for, and a knob moves.
  await page.click("#tab-connect");
  await panel
    .getByRole("combobox", { name: "Parameter to teach" })
    .selectOption("/playing/vibrato");
  await learn.press("Enter");
  await page.waitForFunction(() => globalThis.pretended.input.onmidimessage);
  found.waiting = await word();
  await sendMidi(page, KNOB, 74, 10);
  await sendMidi(page, KNOB, 74, 12); // a knob that trembles is not meant
  found.trembled = await list();
  await commands(page);
  await sendMidi(page, KNOB, 74, 30);
  found.learned = { list: await list(), word: await word(), written: await written(page) };
  await sendMidi(page, KNOB, 74, 127);
  found.followed = await written(page);

  // Its ends are written; they invert it.
  const ends = panel.locator(".binds input");
  await ends.first().fill("40");
  await ends.first().press("Tab");
  found.focused = await page.evaluate(() => document.activeElement.ariaLabel);
  await page.keyboard.type("5");
  await page.keyboard.press("Enter");
  found.ends = [await ends.first().inputValue(), await ends.nth(1).inputValue()];
  await commands(page);
  await sendMidi(page, KNOB, 74, 0);
  await sendMidi(page, KNOB, 74, 127);
  found.spanned = await written(page);

  // By the button beside a parameter; softly, aftertouch and bend too.
  await panel.getByRole("switch", { name: "Soft take-over" }).check();
  await page.click("#tab-all");
  await page.fill("#panel-all input[type=search]", "/body/blend");
  const beside = page.getByRole("button", { name: "Learn: Body to bridge" });
  const learned = page.locator("#panel-all .parameter:not([hidden]) .learned");
  await beside.press("Space");
  found.asked = {
    text: await learned.textContent(),
    pressed: await beside.getAttribute("aria-pressed"),
  };
  await sendMidi(page, TOUCH, 90);
  found.text = await learned.textContent();
  found.knobs = await page.evaluate(() => {
    const rows = [...document.querySelectorAll("#panel-all .parameter")];
    const row = rows.find((one) => one.querySelector("code").textContent === "/bow/speed");
    return row.querySelectorAll(".knob").length;
  });
  await page.click("#tab-connect");
  for (const [target, ...bytes] of [
    ["/playing/bend", WHEEL, 0, 127],
    ["/playing/attack", 0xa0, 70, 99],
    ["/output/gain", KNOB, 20, 0],
  ]) {
    await panel.getByRole("combobox", { name: "Parameter to teach" }).selectOption(target);
    await learn.press("Enter");
    await sendMidi(page, ...bytes);
  }
  await sendMidi(page, KNOB, 20, 99);
  found.all = await list();

  // Whoever stops waiting has taught nothing.
  await learn.press("Enter");
  await panel.getByRole("button", { name: "Stop", exact: true }).press("Enter");
  await sendMidi(page, KNOB, 21, 0);
  await sendMidi(page, KNOB, 21, 127);
  found.stopped = await list();

  found.file = await saved(page);
  found.merged = await page.evaluate(async () => {
    const { merged, readLearned } = await import("/playing/learned.js");
    const { rowOf } = await import("/playing/tables.js");
    const { default: facts } = await import("/facts.js");
    const { learned } = JSON.parse(localStorage.getItem("yehu"));
    const { binds } = merged(facts.mappings.keyboard, readLearned(learned.keyboard));
    return binds.map((bind) => ({ source: bind.source, target: bind.target, row: rowOf(bind) }));
  });

  // Another mapping has nothing learned; the first has it again, also after loading the page anew.
  await page.click("#tab-sound");
  const mapping = page.getByRole("combobox", { name: "What a MIDI" });
  await mapping.selectOption("wind");
  found.ofWind = await list();
  await mapping.selectOption("keyboard");
  await page.reload();
  await page.waitForSelector(READY);
  await page.click("#tab-connect");
  found.reloaded = await list();
  await panel.getByRole("button", { name: "Use MIDI keyboards" }).press("Enter");
  await page.waitForFunction(
    () => globalThis.imitation && globalThis.pretended.input.onmidimessage,
  );
  await commands(page);
  await sendMidi(page, KNOB, 74, 127);
  found.again = await written(page);

  // A tune with a mapping of its own leaves what was taught as it was.
  await page.click("#tab-tunes");
  const tunes = page.locator("#panel-tunes");
  await tunes.getByRole("button", { name: "Listen: MPE phrase" }).click();
  await tunes.getByRole("button", { name: "Stop: MPE phrase" }).click();
  await commands(page);
  await sendMidi(page, KNOB, 74, 0);
  found.afterTune = await written(page);

  await page.click("#tab-connect");
  await panel.getByRole("button", { name: /Forget: CC 74/ }).press("Enter");
  found.forgotten = await list();
  found.focusAfter = await page.evaluate(() => document.activeElement.ariaLabel);
  await commands(page);
  await sendMidi(page, KNOB, 74, 127);
  found.backToMapping = await written(page); // of which CC 74 moves the bow's place
  found.errors = errors;
  return found;
}
