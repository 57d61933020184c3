// Opens the page, presses a key, and prints after how many milliseconds it is heard:
//
//   node page_sounds.mjs URL CHROMIUM

import { READY, contextOf, keepAnalysers, launch, open } from "../../tests/live/page/browser.mjs";

const [url, program] = process.argv.slice(2);
const browser = await launch(program, ["--autoplay-policy=no-user-gesture-required"]);
const context = await contextOf(browser);
await context.addInitScript(keepAnalysers);
const { page, errors } = await open(context, url);
await page.waitForSelector(READY);
const began = Date.now();
await page.click("#start");
await page.keyboard.down("KeyV");
await page.waitForFunction(() => {
  const [analyser] = globalThis.analysers;
  const samples = new Float32Array(analyser?.fftSize ?? 0);
  analyser?.getFloatTimeDomainData(samples);
  return samples.some((sample) => Math.abs(sample) > 0.01);
});
console.log(Date.now() - began);
await browser.close();
if (errors.length) throw new Error(errors.join("\n"));
