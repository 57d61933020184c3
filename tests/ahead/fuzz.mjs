// Posts random events to the WebAssembly module, sensible and wild ones, and computes blocks between
// them.
//
//   node fuzz.mjs JOB.json
//
// A job has: wasm, rate, snapshotLength, seed, count, parameters, kinds.

import { readFileSync } from "node:fs";
import { Kernel, NOW } from "../../web/sound/kernel.js";

const BLOCK = 128;
const AT_ONCE = 1000; // events before a block, below what a block takes from the ring
const WILD = [NaN, Infinity, -Infinity, 1e308, -1e308, 1e-308, 0, -0];

const job = JSON.parse(readFileSync(process.argv[2], "utf8"));
let state = BigInt(job.seed);

/** A random number in 0..1 (a linear congruential generator). */
function random() {
  state = (state * 6364136223846793005n + 1442695040888963407n) & 0xffffffffffffffffn;
  return Number(state >> 11n) / 2 ** 53;
}

const whole = (below) => Math.floor(random() * below);

function number() {
  const way = random();
  if (way < 0.02) return WILD[whole(WILD.length)];
  if (way < 0.1) return (random() - 0.5) * 1e4;
  if (way < 0.5) return 60 + 32 * random();
  return 2 * random() - 0.5;
}

const module = new WebAssembly.Module(readFileSync(job.wasm));
const kernel = new Kernel(module, job.rate, BLOCK, job.snapshotLength);
let [posted, finite, loudest, worst] = [0, true, 0, 0];
while (posted < job.count) {
  for (let i = 0; i < AT_ONCE && posted < job.count; i += 1) {
    const isWild = random() < 0.01;
    const kind = isWild ? whole(1000) - 500 : whole(job.kinds);
    const index = isWild ? whole(1e9) - 5e8 : whole(job.parameters);
    const frame = random() < 0.9 ? NOW : Math.max(0, kernel.frame + whole(4000) - 1000);
    if (kernel.post(frame, kind, index, number(), number())) posted += 1;
  }
  const start = process.hrtime.bigint();
  kernel.compute(BLOCK);
  worst = Math.max(worst, Number(process.hrtime.bigint() - start) / 1e3);
  for (const sample of kernel.out) {
    finite &&= Number.isFinite(sample);
    loudest = Math.max(loudest, Math.abs(sample));
  }
}
process.stdout.write(JSON.stringify({ posted, finite, loudest, worst, lost: kernel.lost }));
