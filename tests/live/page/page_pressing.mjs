/** Presses buttons that begin something, and again before it has begun; prints what was begun and ended. */

import { open, pass } from "./browser.mjs";

/** What has been begun and ended since the last call. @param {import("playwright-core").Page} page */
const done = (page) => page.evaluate(() => globalThis.done.splice(0));

export default async function (browser, url) {
  await browser.addInitScript(() => {
    globalThis.agreed = new Promise((resolve) => (globalThis.agree = resolve));
  });
  let opened = () => {};
  const opens = new Promise((resolve) => (opened = resolve));
  await browser.route("**/sound/sound.js", async (route) => {
    await opens;
    return route.continue();
  });
  const { page, errors } = await open(browser, url);
  const found = {};
  await page.click("#tab-keep");
  const [record, keep] = ["Record", "Keep"].map((name) =>
    page.getByRole("button", { name, exact: true }),
  );
  const pressed = () => page.locator("#panel-keep button[aria-pressed=true]").count();
  // Twice before there is a sound: nothing is to begin.
  for (const button of [record, keep]) {
    const handle = await button.elementHandle();
    await handle.click();
    await handle.click();
  }
  opened();
  await page.waitForFunction(() => globalThis.imitation);
  await pass(page, 100);
  found.twice = { done: await done(page), pressed: await pressed() };
  await record.click();
  found.once = { done: await done(page), pressed: await pressed() };
  // Another sound takes its place: what was recorded is saved.
  const download = page.waitForEvent("download");
  await page.click("#tab-connect");
  await page.locator("#panel-connect").getByText(" Hz").waitFor(); // the page counts from now on
  await page.evaluate(() => (globalThis.imitation.status.dropouts += 1)); // a larger buffer is offered
  await page.getByRole("switch", { name: "Larger buffer" }).check();
  await download;
  found.replaced = { done: await done(page), pressed: await pressed() };

  const hum = await page.getByRole("button", { name: "Use the microphone" }).elementHandle();
  const isOn = () => hum.getAttribute("aria-pressed");
  for (let times = 0; times < 4; times++) await hum.click(); // while the browser asks
  await page.evaluate(() => globalThis.agree());
  await pass(page, 100);
  found.asked = { done: await done(page), isOn: await isOn() };
  await hum.click();
  await pass(page, 100);
  found.hums = { done: await done(page), isOn: await isOn() };
  found.errors = errors;
  return found;
}
