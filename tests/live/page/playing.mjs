/**
 * Plays streams of calls on the page's player, and prints the commands that it posts.
 *
 * The argument is the page's folder. The first line of the input has mappings by name, each as
 * `facts.mappings` has them, or as the name of one and binds that are learned over it; each other line
 * is a stream: calls of methods. Each line of the output has the commands of a stream, five numbers
 * each; a frame of -1 is now. The first one has the tables that were written for each mapping.
 */

import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";

const web = pathToFileURL(`${resolve(process.argv[2])}/`);
const module = readFileSync(new URL("yehu.wasm", web));
const { default: facts } = await import(new URL("facts.js", web).href);
const { Interpreter } = await import(new URL("playing/interpreter.js", web).href);
const { Player } = await import(new URL("playing/player.js", web).href);
const { MAPPINGS, merged, readLearned } = await import(new URL("playing/learned.js", web).href);
const { writeTables } = await import(new URL("playing/tables.js", web).href);

/** What a stream comes to. */
async function play(calls, mappings) {
  const commands = [];
  const player = new Player({ post: (frame, ...fields) => commands.push(frame ?? -1, ...fields) });
  player.playBy(await Interpreter.open(module));
  for (const [method, ...values] of calls) {
    if (method === "remap") values[0] = mappings[values[0]];
    player[method](...values);
  }
  return commands;
}

/** What is written for a mapping: its fields, but for the ends of arrays that are 0. */
function tablesOf(mapping) {
  const tables = new Float64Array(facts.interpreter.length);
  writeTables(tables, mapping, facts.tunings["chaozhou-seven-equal"]);
  return Array.from(tables, (number) => (Number.isNaN(number) ? null : number));
}

const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const mappings = {};
for (const [name, given] of Object.entries(JSON.parse((await lines.next()).value))) {
  const { base, learned } = given;
  mappings[name] = base ? merged(MAPPINGS[base], readLearned(learned)) : given;
}
const tables = Object.entries(mappings).map(([name, mapping]) => [name, tablesOf(mapping)]);
console.log(JSON.stringify(Object.fromEntries(tables)));
for await (const line of lines) console.log(JSON.stringify(await play(JSON.parse(line), mappings)));
