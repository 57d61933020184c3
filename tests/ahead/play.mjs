// Plays commands by the WebAssembly module, for the tests: reads a job as JSON from a file, and
// writes samples (float32, left and right in turn) and a report.
//
//   node play.mjs JOB.json
//
// A job has: wasm, rate, snapshotLength, frames, block, commands ([frame, kind, index, value, other]),
// samples (file to write).

import { readFileSync, writeFileSync } from "node:fs";
import { CHANNELS, Kernel } from "../../web/sound/kernel.js";

const job = JSON.parse(readFileSync(process.argv[2], "utf8"));
const module = new WebAssembly.Module(readFileSync(job.wasm));
const kernel = new Kernel(module, job.rate, job.block, job.snapshotLength);
for (const command of job.commands) kernel.post(...command);
const samples = new Float32Array(CHANNELS * job.frames);
const times = [];
for (let done = 0; done < job.frames; done += job.block) {
  const frames = Math.min(job.block, job.frames - done);
  const start = process.hrtime.bigint();
  kernel.compute(frames);
  times.push(Number(process.hrtime.bigint() - start) / 1e3);
  samples.set(kernel.out.subarray(0, CHANNELS * frames), CHANNELS * done);
}
writeFileSync(job.samples, Buffer.from(samples.buffer));
const sorted = [...times].sort((a, b) => a - b);
process.stdout.write(
  JSON.stringify({
    sources: kernel.sources,
    frame: kernel.frame,
    lost: kernel.lost,
    finite: samples.every(Number.isFinite),
    snapshot: [...kernel.snapshot()],
    values: Array.from({ length: job.parameters ?? 0 }, (_, index) => kernel.value(index)),
    seconds: times.reduce((sum, time) => sum + time, 0) / 1e6,
    medianUs: sorted[sorted.length >> 1],
    worstUs: sorted[sorted.length - 1],
  }),
);
