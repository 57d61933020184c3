/**
 * What the page's player does beside the server's: hands, and calls without a frame.
 *
 * WEB is the page's folder.
 */

import assert from 'node:assert/strict';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { resolve } from 'node:path';

const web = pathToFileURL(`${resolve(process.env.WEB ?? 'web')}/`);
const { default: facts } = await import(new URL('facts.js', web).href);
const { Player } = await import(new URL('playing/player.js', web).href);
const { ParameterError } = await import(new URL('playing/table.js', web).href);

const { BEGIN, END, STOP, LIFT, WRITE } = facts.kinds;
const ROW = Object.fromEntries(facts.parameters.map(({ address, row }) => [address, row]));
const NAMES = Object.fromEntries(Object.entries(facts.kinds).map(([name, kind]) => [kind, name]));
const RATE = 48000;

/** A player, and what is wished through it. */
function playing(style = {}, members = {}) {
  const wishes = [];
  const sink = {
    post: (frame, kind, index, value, other) => wishes.push({ frame, kind, index, value, other }),
    frame: 0,
    rate: RATE,
    ...members,
  };
  const player = new Player(facts, sink, style);
  const of = (...kinds) => wishes.filter((wish) => kinds.includes(wish.kind));
  return { player, wishes, sink, of };
}

/** The keys that are held after some wishes. */
function heldAfter(wishes) {
  const held = new Set();
  for (const { kind, index, value } of wishes) {
    if (kind === BEGIN) held.add(`${index} ${value}`);
    if (kind === END) held.delete(`${index} ${value}`);
  }
  return held.size;
}

test('two fingers at one pitch are two notes', () => {
  const { player, wishes } = playing();
  player.noteOn('left', 70, 0.5);
  player.noteOn('right', 70, 0.5);
  player.noteOff('left');
  assert.equal(heldAfter(wishes), 1);
  player.noteOff('right');
  assert.equal(heldAfter(wishes), 0);
});

test('a hand that takes another key slurs: the old note ends after the new one has begun', () => {
  const { player, of } = playing();
  player.noteOn('hand', 70, 0.5);
  player.noteOn('hand', 72, 0.5);
  const order = of(BEGIN, END).map(({ kind, value }) => [NAMES[kind], value]);
  assert.deepEqual(order, [['BEGIN', 70], ['BEGIN', 72], ['END', 70]]);
  player.noteOff('hand');
  player.noteOff('hand');
  assert.equal(of(END).length, 2);
});

test('whatever ten fingers do, no note is left when all are up', () => {
  const { player, wishes, of } = playing();
  let seed = 1;
  const chance = (most) => (seed = (seed * 16807) % 2147483647) % most;
  for (let step = 0; step < 5000; step += 1) {
    const id = chance(10);
    if (chance(2)) player.noteOn(id, 60 + chance(35), 0.5);
    else player.noteOff(id);
  }
  for (let id = 0; id < 10; id += 1) player.noteOff(id);
  assert.ok(of(BEGIN).length > 2000);
  assert.equal(heldAfter(wishes), 0);
});

test('a key is tuned, a finger at a pitch is not', () => {
  const { player, of } = playing({ tuning: 'chaozhou-seven-equal' });
  player.noteOn('key', 67, 0.5);
  player.fingerOn('finger', 67, 0.5);
  const [key, finger] = of(BEGIN).map((wish) => wish.other);
  assert.ok(Math.abs(key - facts.tunings['chaozhou-seven-equal'].keys[67]) % 12 < 1e-9);
  assert.notEqual(key, 67);
  assert.equal(finger, 67);
});

test('a key that a hand takes after a finger is tuned again', () => {
  const { player, of } = playing({ tuning: 'chaozhou-seven-equal' });
  player.fingerOn('hand', 67, 0.5);
  player.noteOff('hand');
  player.noteOn('hand', 67, 0.5);
  const [finger, key] = of(BEGIN);
  assert.equal(finger.index, key.index);
  assert.notEqual(finger.other, key.other);
});

test('a tuning applies from the next note on, and null is equal temperament', () => {
  const { player, of } = playing();
  player.applyTuning('chaozhou-seven-equal');
  player.noteOn('key', 67, 0.5);
  player.applyTuning(null);
  player.noteOn('key', 67, 0.5);
  const [tuned, equal] = of(BEGIN).map((wish) => wish.other);
  assert.notEqual(tuned, 67);
  assert.equal(equal, 67);
});

test('without a frame wishes are for now', () => {
  const { player, wishes } = playing();
  player.noteOn('hand', 70, 0.5);
  player.write('/playing/vibrato', 20);
  player.noteOff('hand');
  player.panic();
  assert.ok(wishes.every((wish) => wish.frame === null));
});

test('a note that is to begin ends no sooner, also where its end is for now', () => {
  const { player, of } = playing({}, { frame: 1000 });
  player.midi([0x90, 70, 90], 5000);
  player.midi([0x80, 70, 0]);
  assert.equal(of(END)[0].frame, 5000);
});

test('panic comes after what is wished ahead, unless that is far ahead', () => {
  const { player, of } = playing({}, { frame: 1000 });
  player.midi([0x90, 70, 90], 5000);
  player.panic();
  assert.equal(of(STOP)[0].frame, 5000);
  player.midi([0x90, 70, 90], 1000 + 10 * RATE);
  player.panic();
  assert.equal(of(LIFT)[1].frame, null);
});

test('a port that is gone ends what it wished ahead', () => {
  const { player, of } = playing();
  player.midi([0x90, 70, 90], 4000, 3);
  player.midi([0x90, 72, 90], 5000, 3);
  player.letGoOf(3);
  assert.deepEqual(of(END).map((wish) => wish.frame), [5000, 5000]);
  player.midi([0xe0, 0, 127], 6000, 4);
  player.letGoOf(4);
  const bends = of(WRITE).filter((wish) => wish.index === ROW['/playing/bend']);
  assert.deepEqual(bends.map(({ frame, value }) => [frame, value > 1]), [[6000, true], [6000, false]]);
});

test('panic lets go of what hands hold', () => {
  const { player, of } = playing();
  player.noteOn('hand', 70, 0.5);
  player.panic();
  const count = of(END).length;
  player.noteOff('hand');
  assert.equal(of(END).length, count);
});

test('a written parameter of the bow is told at once, later as it moves', () => {
  const { player, sink } = playing({}, { target: () => 0.25 });
  assert.equal(player.value('/bow/speed'), 0.25);
  player.write('/bow/speed', 0.1);
  player.draw(0.2, 1);
  assert.equal(player.value('/bow/speed'), 0.2);
  assert.equal(player.value('/bow/assist'), 0);
  sink.frame += RATE;
  assert.equal(player.value('/bow/speed'), 0.25);
});

test('what does not exist or is no number is refused, and changes nothing', () => {
  const { player, wishes } = playing();
  const count = wishes.length;
  const refused = [
    () => player.write('/playing/nothing', 1),
    () => player.write('/playing/vibrato', NaN),
    () => player.value('/nothing'),
    () => player.noteOn('hand', 128, 0.5),
    () => player.noteOn('hand', 70, NaN),
    () => player.slide(-1),
    () => player.applyPreset('nothing'),
    () => player.applyPreset('constructor'),
    () => player.applyMapping('nothing'),
    () => player.applyTuning('nothing'),
  ];
  for (const call of refused) assert.throws(call, ParameterError);
  assert.equal(wishes.length, count);
});

test('a preset sets what it names, but nothing that is held', () => {
  const { player } = playing();
  player.hold('/playing/pressure', 0.7);
  player.applyPreset('flautando');
  const { values } = facts.presets.shipped.flautando;
  for (const [address, value] of Object.entries(values)) {
    const expected = address === '/playing/pressure' ? 0.7 : value;
    assert.equal(player.value(address), expected, address);
  }
});
