// Plays steps by the WebAssembly module, for the tests, and writes the memory of the instrument at the
// end, as streams.c does; and the samples (float32, left and right in turn).
//
//   node streams.mjs JOB.json
//
// A job has: wasm, rate, snapshotLength, steps and tables (files), blocks, reporting, memory and samples
// (files to write).

import { readFileSync, writeFileSync } from "node:fs";
import { CHANNELS, Kernel } from "../../web/sound/kernel.js";

const BLOCK = 128;
const ROOM = 1 << 15; // frames: the samples leave room for tables

const job = JSON.parse(readFileSync(process.argv[2], "utf8"));
const kernel = new Kernel(
  new WebAssembly.Module(readFileSync(job.wasm)),
  job.rate,
  ROOM,
  job.snapshotLength,
);
const wasm = kernel.exported;
const given = new Uint8Array(kernel.view.buffer, kernel.at.out, 8 * ROOM);
const tables = readFileSync(job.tables);
const size = tables.length / job.count;

/** Do what a line says; returns what the function does. */
function step(name, frame, ...numbers) {
  const at = BigInt(frame);
  if (name === "map") {
    const first = size * Number(numbers[0]);
    given.set(tables.subarray(first, first + size));
    return wasm.yehu_use_tables(kernel.at.rig, at, kernel.at.out, BigInt(size));
  }
  if (name === "midi") {
    const [count, ...bytes] = numbers.map(Number);
    given.set(bytes);
    return wasm.yehu_midi(kernel.at.rig, at, kernel.at.out, BigInt(count)) >= 0n ? 1n : 0n;
  }
  if (name === "control") {
    return wasm.yehu_control(kernel.at.rig, at, BigInt(numbers[0]), Number(numbers[1]));
  }
  const [kind, index, value, other] = numbers;
  return wasm.yehu_post(
    kernel.at.rig,
    at,
    BigInt(kind),
    BigInt(index),
    Number(value),
    Number(other),
  );
}

kernel.view.setBigInt64(kernel.at.rig + 8 * job.reporting, 1n, true);
const lines = readFileSync(job.steps, "utf8").trimEnd().split("\n");
const samples = new Float32Array(CHANNELS * BLOCK * job.blocks);
let next = 0;
for (let block = 1; block <= job.blocks; block += 1) {
  while (next < lines.length && Number(lines[next].split(" ")[1]) < block * BLOCK) {
    if (step(...lines[next].split(" ")) !== 1n) throw new Error(`line ${next + 1} was not taken`);
    next += 1;
  }
  kernel.compute(BLOCK);
  samples.set(kernel.out.subarray(0, CHANNELS * BLOCK), CHANNELS * BLOCK * (block - 1));
}
const length = Number(wasm.yehu_size());
writeFileSync(job.samples, samples);
writeFileSync(job.memory, new Uint8Array(kernel.view.buffer, kernel.at.rig, length));
process.stdout.write(JSON.stringify({ finite: samples.every(Number.isFinite), lost: kernel.lost }));
