/**
 * Plays streams of calls on the page's player, and prints the wishes that it posts.
 *
 * The argument is the page's folder. Each line of the input is a stream: the style, and calls of
 * methods; the first line has mappings beside the shipped ones. Each line of the output has the
 * wishes of a stream, five numbers each, and what the player tells at the end. Null is -1.
 */

import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';
import { resolve } from 'node:path';

const web = pathToFileURL(`${resolve(process.argv[2])}/`);
const { default: facts } = await import(new URL('facts.js', web).href);
const { Player } = await import(new URL('playing/player.js', web).href);

/** What a stream comes to. */
function play({ style, calls }, shipped) {
  const wishes = [];
  const post = (frame, ...fields) => wishes.push(frame ?? -1, ...fields);
  const player = new Player(shipped, { post, frame: 0, rate: 48000 }, style);
  for (const [method, ...values] of calls) player[method](...values);
  const positions = player.bindings().map(([, position]) => position ?? -1);
  return { wishes, sound: [...player.sound().values()], positions };
}

const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const first = JSON.parse((await lines.next()).value);
const shipped = { ...facts, mappings: { ...facts.mappings, ...first } };
for await (const line of lines) console.log(JSON.stringify(play(JSON.parse(line), shipped)));
