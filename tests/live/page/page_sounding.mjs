/**
 * Plays the page itself, with its WebAssembly, as a static site: over https's stand-in, loopback, and
 * over plain http under a name that browsers don't trust.
 *
 * Words: a folder for downloads, and a tune or none. With a tune that tune is played to its end, and
 * nothing else.
 */

import { UNTRUSTED, keepAnalysers, open, pass } from "./browser.mjs";

const KEY = "KeyV"; // B4
const DEPRECATED = "ScriptProcessorNode is deprecated"; // but there is nothing else there

/**
 * Start the sound by a key; wait until it is heard.
 * @param {import("playwright-core").Page} page
 */
async function start(page) {
  await page.click("#start");
  await page.keyboard.down(KEY);
  await page.waitForFunction(() => {
    const [analyser] = globalThis.analysers;
    const samples = new Float32Array(analyser?.fftSize ?? 0);
    analyser?.getFloatTimeDomainData(samples);
    return samples.some((sample) => Math.abs(sample) > 0.01);
  });
}

/**
 * Press a button and save what it offers.
 * @param {import("playwright-core").Page} page
 * @param {import("playwright-core").Locator} button
 * @param {string} path
 */
async function save(page, button, path) {
  const download = page.waitForEvent("download");
  await button.click();
  await (await download).saveAs(path);
}

/** @param {import("playwright-core").Page} page @param {string} folder */
async function playAndKeep(page, folder) {
  await page.click("#tab-keep");
  await page.getByRole("button", { name: "Record", exact: true }).click();
  await page.getByRole("button", { name: "Keep", exact: true }).click();
  await page.keyboard.down(KEY);
  await pass(page, 1000);
  const status = await page.getAttribute("#status", "data-state");
  await page.keyboard.up(KEY);
  await pass(page, 300);
  const pressed = page.locator("#panel-keep button[aria-pressed=true]");
  await pressed.first().click();
  await save(page, page.getByRole("button", { name: "Save as a file" }), `${folder}/kept.jsonl`);
  await save(page, pressed.first(), `${folder}/recorded.wav`);
  return status;
}

export default async function (browser, url, { words: [folder, tune] }) {
  await browser.addInitScript(keepAnalysers);
  let asked = 0;
  browser.on("request", (request) => {
    if (request.url().endsWith("yehu.wasm") && !request.serviceWorker()) asked += 1;
  });
  const { page, errors } = await open(browser, url);
  await start(page);
  const found = { asked };
  await page.keyboard.up(KEY);
  if (tune) {
    await page.click("#tab-tunes");
    await page.getByRole("button", { name: `Listen: ${tune}` }).click();
    await pass(page, 5000);
    const stop = page.locator("#panel-tunes").getByRole("button", { name: `Stop: ${tune}` });
    found.pressed = await stop.getAttribute("aria-pressed");
    await page.waitForFunction(
      () => !document.querySelector("#panel-tunes [aria-pressed=true]"),
      undefined,
      { timeout: 90_000 },
    );
    return { ...found, errors };
  }
  found.status = await playAndKeep(page, folder);
  const untrusted = await open(browser, url.replace("127.0.0.1", UNTRUSTED));
  found.secure = await untrusted.page.evaluate(() => isSecureContext);
  await start(untrusted.page);
  await untrusted.page.keyboard.up(KEY);
  await untrusted.page.click("#tab-keep");
  await untrusted.page.getByRole("button", { name: "Record", exact: true }).click();
  await untrusted.page.keyboard.down(KEY);
  await pass(untrusted.page, 1000);
  const pressed = untrusted.page.locator("#panel-keep button[aria-pressed=true]");
  await save(untrusted.page, pressed.first(), `${folder}/script.wav`);
  const others = untrusted.errors.filter((error) => !error.includes(DEPRECATED));
  return { ...found, errors: [...errors, ...others] };
}
