/** The sound of another clock is heard without a gap; prints what was found for each clock. */

import { pathToFileURL } from "node:url";

const [file, seconds] = process.argv.slice(2);
const { JitterBuffer } = await import(pathToFileURL(file).href);

const RATE = 48000;
const BLOCK = 128;
const SETTLED_S = 5;
const PERIOD = Float32Array.from({ length: RATE / 1000 }, (_, n) =>
  Math.sin((2 * Math.PI * 1000 * n) / RATE),
);

/** Numbers that look random, and are the same each time. */
function randoms() {
  let state = 1;
  return () => (state = (state * 16807) % 2147483647) / 2147483647;
}

/**
 * Listen for a while to a tone of 1 kHz at the left, and its inverse at the right, half as loud.
 * @param {{ppm: number, seconds: number, lateS: number, ownRate?: number}} options
 */
function listen({ ppm, seconds, lateS, ownRate = RATE }) {
  const sound = new JitterBuffer(ownRate, RATE);
  const random = randoms();
  const [out, right] = [new Float32Array(BLOCK), new Float32Array(BLOCK)];
  let unlike = 0; // most that right is not minus half of left
  const fills = [];
  const crossings = []; // frames
  let [sent, sendAt, before] = [0, 0, 0];
  for (let block = 0; block * BLOCK < seconds * ownRate; block++) {
    const now = (block * BLOCK) / ownRate;
    for (; sendAt <= now; sendAt += 0.0025 + lateS * random()) {
      const made = Math.floor((sendAt * RATE * (1 + ppm * 1e-6)) / BLOCK) * BLOCK;
      const samples = new Float32Array(2 * (made - sent));
      for (let i = 0; i < made - sent; i++) {
        samples[2 * i] = PERIOD[(sent + i) % PERIOD.length];
        samples[2 * i + 1] = -0.5 * samples[2 * i];
      }
      if (made > sent) sound.write(sent, samples);
      sent = made;
    }
    sound.fillIn(out, right);
    for (let i = 0; i < BLOCK; i++) unlike = Math.max(unlike, Math.abs(right[i] + 0.5 * out[i]));
    if (now < SETTLED_S) continue;
    fills.push(sound.fill);
    out.forEach((sample, i) => {
      if (before < 0 && sample >= 0) crossings.push(block * BLOCK + i);
      before = sample;
    });
  }
  const frequency = ((crossings.length - 1) * ownRate) / (crossings.at(-1) - crossings[0]);
  fills.sort((one, other) => one - other);
  return { gaps: sound.gaps, aim: sound.aim, most: fills.at(-1), frequency, unlike };
}

console.log(
  JSON.stringify({
    fast: listen({ ppm: 200, seconds: Number(seconds), lateS: 0.003 }),
    slow: listen({ ppm: -200, seconds: Number(seconds), lateS: 0.003 }),
    otherRate: listen({ ppm: 0, seconds: Number(seconds), lateS: 0.003, ownRate: 44100 }),
    late: listen({ ppm: 0, seconds: 30, lateS: 0.05 }),
  }),
);
