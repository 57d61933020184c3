/**
 * Plays scenarios in one browser, one after another, for as long as somebody asks for them.
 *
 *   node driver.mjs SHELL CHROMIUM
 *
 * SHELL is a Chromium without a user interface of its own, or CHROMIUM too.
 *
 * Each line of the input asks for one: {"scenario": FILE, "url": URL, "words": [...]}. Lines of the output
 * are {"step": NAME}, where the scenario waits for a line of the input, and in the end {"found": ...} or
 * {"failed": TEXT}. Nothing is remembered from one scenario to the next.
 *
 * A scenario exports a function as its default, which gets a browser's context and the URL, and may export
 * `flags` for a browser of its own, and its `environment`, `hasTabs` if that has to be CHROMIUM, whose tabs take
 * the focus from each other, and `isDrawnInFull` if frames are to come as fast as they can.
 */

import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";
import { contextOf, drawSeldom, launch } from "./browser.mjs";

const [, , shell, chromium] = process.argv;
const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const say = (line) => console.log(JSON.stringify(line));

/** Report where the scenario is, and wait until that is answered. @param {string} step */
async function reach(step) {
  say({ step });
  await lines.next();
}

/** Play a scenario; return what it found. @param {import("playwright-core").Browser} shared */
async function play(shared, { scenario, url, words }) {
  const {
    default: run,
    flags,
    environment,
    hasTabs,
    isDrawnInFull,
  } = await import(pathToFileURL(scenario).href);
  const isOwn = flags || environment || hasTabs;
  const program = hasTabs ? chromium : shell;
  const browser = isOwn ? await launch(program, flags?.(words), environment?.(words)) : shared;
  const context = await contextOf(browser);
  try {
    if (!isDrawnInFull) await context.addInitScript(drawSeldom);
    return (await run(context, url, { words, reach })) ?? null;
  } finally {
    await context.close();
    if (isOwn) await browser.close();
  }
}

const browser = await launch(shell);
for await (const line of lines) {
  try {
    say({ found: await play(browser, JSON.parse(line)) });
  } catch (error) {
    say({ failed: error.stack });
  }
}
await browser.close();
