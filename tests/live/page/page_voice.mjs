/**
 * Hums into the page, by a file that stands for a microphone, and keeps what it plays.
 *
 * Words: that file, and a folder for what is kept.
 */

import { open, pass } from "./browser.mjs";

/** What makes of a file a microphone. @param {string[]} words */
export const flags = ([hum]) => [
  "--use-fake-device-for-media-stream",
  "--use-fake-ui-for-media-stream",
  `--use-file-for-fake-audio-capture=${hum}%noloop`,
];

export default async function (browser, url, { words: [, folder] }) {
  const { page, errors } = await open(browser, url);
  await page.click("#tab-keep"); // what it asks for there begins the sound
  await page.getByRole("button", { name: "Keep", exact: true }).click();
  await page.getByRole("button", { name: "Record", exact: true }).click();
  await page.click("#tab-connect");
  await page.getByRole("switch", { name: "In tune", exact: true }).check();
  await page.getByRole("button", { name: "Use the microphone" }).click();
  const word = page.getByText("Wear headphones");
  await word.waitFor();
  await pass(page, 3000);
  await page.locator("#panel-connect canvas").scrollIntoViewIfNeeded();
  // Pixels of the reddish band and of the bluish line; all else is nearly grey.
  const pixels = await page.locator("#panel-connect canvas").evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const count = { heard: 0, played: 0 };
    for (let i = 0; i < data.length; i += 4) {
      const [red, , blue, alpha] = data.subarray(i, i + 4);
      if (alpha > 60 && red - blue > 60) count.heard += 1;
      if (alpha > 60 && blue - red > 60) count.played += 1;
    }
    return count;
  });
  await page.screenshot({ path: `${folder}/voice.png` });
  const pressed = page.locator("#panel-keep button[aria-pressed=true]");
  await page.locator("#panel-connect button[aria-pressed=true]").click();
  await page.click("#tab-keep");
  await pressed.first().click(); // what was kept
  for (const [button, name] of [
    [page.getByRole("button", { name: "Save as a file" }), "hum.jsonl"],
    [pressed.first(), "hum.wav"],
  ]) {
    const download = page.waitForEvent("download");
    await button.click();
    await (await download).saveAs(`${folder}/${name}`);
  }
  return { errors, pixels, still: await word.count() };
}
