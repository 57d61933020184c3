/**
 * Plays tunes on the page's instrument, and prints the string and finger that are printed of each note beside
 * those that are seen on the strings.
 *
 * The arguments: the page's folder, presets, tunes, and articulations.
 */

import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";

const [folder, presets, tunes, articulations] = process.argv.slice(2);
const web = pathToFileURL(`${resolve(folder)}/`);
const load = (/** @type {string} */ name) => import(new URL(name, web).href);
globalThis.document = /** @type {any} */ ({ querySelector: () => null });
const { default: facts } = await load("facts.js");
const { default: examples } = await load("examples.js");
const { fingerOf } = await load("hands/scale.js");
const { Interpreter } = await load("playing/interpreter.js");
const { MAPPINGS } = await load("playing/learned.js");
const { Player } = await load("playing/player.js");
const { Kernel } = await load("sound/kernel.js");
const { playedString, snapshotOf } = await load("sound/snapshot.js");
const { TunePlayer } = await load("tune.js");

const RATE = 48000;
const BLOCK = 128;
const SECONDS = 7;
const SEEN_AT = 0.75; // of a note
const bytes = readFileSync(new URL("yehu.wasm", web));
const module = new WebAssembly.Module(bytes);

/** What is seen: the string, and the finger on it. */
function seenOf(state) {
  const string = playedString(state);
  const stop = Math.max(0, ...state.fingers.map(({ x }) => x));
  const pitch = facts.notes.OPEN[string] - 12 * Math.log2(1 - stop / state.string.length);
  return [string, stop === 0 ? 0 : fingerOf(pitch, string)];
}

async function play(preset, tune, articulation) {
  const kernel = new Kernel(module, RATE, BLOCK, facts.snapshotLength);
  const post = (frame, ...fields) => kernel.post(frame ?? kernel.frame, ...fields);
  const player = new Player({ post, rate: RATE });
  player.playBy(await Interpreter.open(bytes));
  player.applyPreset(preset);
  const number = facts.articulations.findIndex(({ name }) => name === articulation);
  player.write("/playing/articulation", number);
  player.remap(MAPPINGS[tune.mapping]);
  const { notes, fingering } = new TunePlayer({ player }, tune, 1);
  const events = tune.events.filter(([at]) => at < SECONDS);
  for (const [at, message] of events) player.midi(message, Math.round(at * RATE));
  return notes
    .filter(({ until }) => until < SECONDS)
    .map(({ at, until }, i) => {
      while (kernel.frame < RATE * (at + SEEN_AT * (until - at))) kernel.compute(BLOCK);
      const { string, finger } = fingering[i];
      return { printed: [string, finger], seen: seenOf(snapshotOf(kernel.snapshot())) };
    });
}

const found = {};
for (const preset of presets.split(",")) {
  for (const name of tunes.split(","))
    for (const articulation of articulations.split(","))
      found[`${preset} ${name} ${articulation}`] = await play(preset, examples[name], articulation);
}
console.log(JSON.stringify(found));
