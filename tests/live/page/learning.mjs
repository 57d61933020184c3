/**
 * Learns from streams of MIDI messages as the page does, and prints what it learned.
 *
 * The argument is the page's folder. Each line of the input is a stream: the name of a mapping, and
 * lessons: [target, whether it is soft and alone, messages of port and bytes], or [target] to forget it. Each
 * line of the output has the source that each lesson found, the binds at the end, and their file.
 */

import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";

const web = pathToFileURL(`${resolve(process.argv[2])}/`);
const { default: facts } = await import(new URL("facts.js", web).href);
const { Learner } = await import(new URL("playing/learner.js", web).href);
const { bindOf, fileOf, merged, readLearned, withBind, withoutBinds } = await import(
  new URL("playing/learned.js", web).href
);
const { rowOf } = await import(new URL("playing/tables.js", web).href);

/** The first source that is meant. */
function heard(messages) {
  const learner = new Learner();
  for (const [port, bytes] of messages) {
    const source = learner.hear(bytes, port);
    if (source !== null) return source;
  }
  return null;
}

for await (const line of createInterface({ input: process.stdin })) {
  const { name, lessons } = JSON.parse(line);
  const mapping = facts.mappings[name];
  const sources = [];
  let learned = [];
  for (const [target, [isSoft, isAlone] = [], messages] of lessons) {
    const source = messages ? heard(messages) : null;
    sources.push(source);
    if (source !== null) learned = withBind(learned, bindOf(target, source, isSoft, isAlone));
    const own = learned.filter((bind) => bind.target === target);
    if (!messages) learned = withoutBinds(learned, own);
  }
  learned = readLearned(JSON.parse(JSON.stringify(learned))); // as a browser keeps them
  const binds = merged(mapping, learned).binds.map((bind) => {
    const { source, target, channels } = bind;
    return { source, target, channels, row: rowOf(bind) };
  });
  console.log(JSON.stringify({ sources, binds, file: fileOf(name, mapping, learned) }));
}
