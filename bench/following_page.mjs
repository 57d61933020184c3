/**
 * Sings into the page's microphone by a file, and writes what its AudioContext was given and played:
 * float samples, the microphone's and the page's in turn. Prints what the browser reports of itself.
 *
 *   node following_page.mjs URL CHROMIUM SONG.wav SECONDS RECORDED
 */

import { writeFileSync } from "node:fs";
import { contextOf, launch, open } from "../tests/live/page/browser.mjs";

const [url, program, song, seconds, recorded] = process.argv.slice(2);
const MICROPHONE = [
  "--use-fake-device-for-media-stream",
  "--use-fake-ui-for-media-stream",
  `--use-file-for-fake-audio-capture=${song}%noloop`,
];

/** Records what comes from a microphone and what goes to the device, in step; runs in the page. */
function recordBoth() {
  const { connect } = AudioNode.prototype;
  const parts = [];
  let merger;
  /** @param {AudioContext} context */
  const mergerOf = (context) => {
    merger = context.createChannelMerger(2);
    const processor = context.createScriptProcessor(16384, 2, 1);
    processor.onaudioprocess = ({ inputBuffer }) => {
      const both = new Float32Array(2 * inputBuffer.length);
      for (const channel of [0, 1]) {
        const samples = inputBuffer.getChannelData(channel);
        for (let i = 0; i < samples.length; i++) both[2 * i + channel] = samples[i];
      }
      parts.push(both);
    };
    connect.call(merger, processor);
    connect.call(processor, context.destination);
    return merger;
  };
  AudioNode.prototype.connect = function connectBoth(to, ...words) {
    const { context } = this;
    if (this instanceof MediaStreamAudioSourceNode) {
      connect.call(this, merger, 0, 0);
      globalThis.measured = {
        rate: context.sampleRate,
        base: context.baseLatency,
        output: () => context.outputLatency,
        input: this.mediaStream.getAudioTracks()[0].getSettings().latency,
      };
    } else if (to === context.destination) {
      connect.call(this, mergerOf(context), 0, 1);
    }
    return connect.call(this, to, ...words);
  };
  globalThis.recordedText = async () => {
    const url = await new Promise((resolve) => {
      const reader = new FileReader();
      reader.onload = () => resolve(reader.result);
      reader.readAsDataURL(new Blob(parts));
    });
    return url.slice(url.indexOf(",") + 1);
  };
}

const browser = await launch(program, MICROPHONE);
const context = await contextOf(browser);
await context.addInitScript(recordBoth);
const { page, errors } = await open(context, url);
await page.click("#play");
await page.click("#tab-connect");
await page.getByRole("button", { name: "Use the microphone" }).click();
await page.getByText("Wear headphones").waitFor();
await page.waitForTimeout(1000 * Number(seconds));
const text = await page.evaluate(() => globalThis.recordedText());
writeFileSync(recorded, Buffer.from(text, "base64"));
const measured = await page.evaluate(
  (found) => ({ ...globalThis.measured, output: globalThis.measured.output(), errors: found }),
  errors,
);
console.log(JSON.stringify(measured));
await browser.close();
