/**
 * What the page's player does beside interpreting: hands, calls without a frame, what others set.
 *
 * WEB is the page's folder; EVERYTHING is not empty where what is long is wanted as well.
 */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";

const web = pathToFileURL(`${resolve(process.env.WEB ?? "web")}/`);
const EVERYTHING = Boolean(process.env.EVERYTHING);
const module = readFileSync(new URL("yehu.wasm", web));
const { default: facts } = await import(new URL("facts.js", web).href);
const { Interpreter } = await import(new URL("playing/interpreter.js", web).href);
const { MAPPINGS, bindOf, merged } = await import(new URL("playing/learned.js", web).href);
const { Player } = await import(new URL("playing/player.js", web).href);
const { ParameterError } = await import(new URL("playing/table.js", web).href);
const { Kernel, NOW } = await import(new URL("sound/kernel.js", web).href);

const { BEGIN, END, STOP, LIFT, WRITE, EXPRESS } = facts.kinds;
const INDEX = Object.fromEntries(facts.parameters.map(({ address, index }) => [address, index]));
const NAMES = Object.fromEntries(Object.entries(facts.kinds).map(([name, kind]) => [kind, name]));
const RATE = 48000;
const LOUDNESS = "/playing/dynamics";
const SECTION = "/playing/section";

/** A player, and what is requested through it. */
async function playing(members = {}) {
  const commands = [];
  const sink = {
    post: (frame, kind, index, value, other) => commands.push({ frame, kind, index, value, other }),
    frame: 0,
    rate: RATE,
    ...members,
  };
  const player = new Player(sink);
  player.playBy(await Interpreter.open(module));
  const of = (...kinds) => commands.filter((command) => kinds.includes(command.kind));
  const values = (kind, address) =>
    of(kind)
      .filter(({ index }) => index === INDEX[address])
      .map(({ value }) => value);
  return { player, commands, sink, of, values };
}

/** The keys that are held after some commands. */
function heldAfter(commands) {
  const held = new Set();
  for (const { kind, index, value } of commands) {
    if (kind === BEGIN) held.add(`${index} ${value}`);
    if (kind === END) held.delete(`${index} ${value}`);
  }
  return held.size;
}

test("two fingers at one pitch are two notes", async () => {
  const { player, commands } = await playing();
  player.fingerOn("left", 70, 0.5);
  player.fingerOn("right", 70, 0.5);
  player.noteOff("left");
  assert.equal(heldAfter(commands), 1);
  player.noteOff("right");
  assert.equal(heldAfter(commands), 0);
});

test("a hand that takes another pitch slurs: the old note ends after the new one has begun", async () => {
  const { player, of } = await playing();
  player.fingerOn("hand", 70, 0.5);
  player.fingerOn("hand", 72, 0.5);
  const order = of(BEGIN, END).map(({ kind, value }) => [NAMES[kind], value]);
  assert.deepEqual(order, [
    ["BEGIN", 70],
    ["BEGIN", 72],
    ["END", 70],
  ]);
  player.noteOff("hand");
  player.noteOff("hand");
  assert.equal(of(END).length, 2);
});

test("whatever ten fingers do, no note is left when all are up", async () => {
  const { player, commands, of } = await playing();
  let seed = 1;
  const chance = (most) => (seed = (seed * 16807) % 2147483647) % most;
  for (let step = 0; step < (EVERYTHING ? 5000 : 1000); step += 1) {
    const id = chance(10);
    if (chance(2)) player.fingerOn(id, 60 + chance(35), 0.5);
    else player.noteOff(id);
  }
  for (let id = 0; id < 10; id += 1) player.noteOff(id);
  assert.ok(of(BEGIN).length > (EVERYTHING ? 2000 : 400));
  assert.equal(heldAfter(commands), 0);
});

test("a key of MIDI is tuned, from the next note on; a finger is not", async () => {
  const { player, of } = await playing();
  player.applyTuning("chaozhou-seven-equal");
  player.midi([0x90, 67, 90]);
  player.fingerOn("finger", 67, 0.5);
  player.applyTuning("equal");
  player.midi([0x90, 67, 90]);
  const [key, finger, equal] = of(BEGIN).map((command) => command.other);
  assert.equal(key, facts.tunings["chaozhou-seven-equal"].keys[67]);
  assert.notEqual(key, 67);
  assert.deepEqual([finger, equal], [67, 67]);
});

test("without a frame commands are for now", async () => {
  const { player, commands } = await playing();
  player.fingerOn("hand", 70, 0.5);
  player.write("/playing/vibrato", 20);
  player.noteOff("hand");
  player.panic();
  assert.ok(commands.every((command) => command.frame === null));
});

test("a key that is struck twice for now ends once it is released", async () => {
  const { player, of } = await playing();
  for (const velocity of [90, 91, 0]) player.midi([0x90, 70, velocity]);
  assert.equal(of(END).length, 1);
});

test("a note that is to begin is silent where its end is for now", async () => {
  for (const [ended, isSilent] of [
    [() => {}, false],
    [({ player }) => player.midi([0x80, 70, 0]), true],
  ]) {
    const kernel = new Kernel(new WebAssembly.Module(module), RATE, 4800, facts.snapshotLength);
    const made = await playing();
    made.player.midi([0x90, 70, 90], 960);
    ended(made);
    for (const { frame, kind, index, value, other } of made.commands) {
      kernel.post(frame ?? 0, kind, index, value, other);
    }
    kernel.compute(4800);
    assert.equal(Math.max(...kernel.out) < 1e-3, isSilent);
  }
});

test("a touch is heard within 100 ms: what comes to it is the browser's own latency", async () => {
  const late = [];
  for (let pitch = 65; pitch <= 89; pitch += EVERYTHING ? 1 : 6) {
    const kernel = new Kernel(new WebAssembly.Module(module), RATE, 128, facts.snapshotLength);
    const post = (frame, ...command) => kernel.post(frame ?? NOW, ...command);
    const { player } = await playing({ post });
    for (const preset of ["vibrato", "chamber"]) player.applyPreset(preset); // as the page begins
    player.fingerOn("hand", pitch, 0.63);
    let ms = 0;
    for (; ms < 1000 && kernel.out.every((one) => Math.abs(one) < 1e-3); ms += 128e3 / RATE) {
      kernel.compute(128);
    }
    if (ms > 60) late.push([pitch, ms]); // 5 to 16 ms
  }
  assert.deepEqual(late, []);
});

test("panic comes after what is requested ahead, unless that is far ahead", async () => {
  const { player, of } = await playing({ frame: 1000 });
  player.midi([0x90, 70, 90], 5000);
  player.panic();
  assert.equal(of(STOP)[0].frame, 5000);
  player.midi([0x90, 70, 90], 1000 + 10 * RATE);
  player.panic();
  assert.equal(of(LIFT)[1].frame, null);
});

test("a port that is gone ends what it requested ahead", async () => {
  const { player, of, values } = await playing();
  player.midi([0x90, 70, 90], 4000, 3);
  player.midi([0x90, 72, 90], 5000, 3);
  player.endPortNotes(3);
  assert.deepEqual(
    of(END).map((command) => command.frame),
    [5000, 5000],
  );
  player.midi([0xe0, 0, 127], 6000, 4);
  player.endPortNotes(4);
  assert.deepEqual(
    values(WRITE, "/playing/bend").map((bend) => bend > 1),
    [true, false],
  );
});

test("panic lets go of what hands hold", async () => {
  const { player, of } = await playing();
  player.fingerOn("hand", 70, 0.5);
  player.panic();
  const count = of(END).length;
  player.fingerOn("other", 70, 0.5);
  const [before, after] = of(BEGIN);
  assert.equal(after.index, before.index); // the channel is free again
  player.noteOff("hand");
  assert.equal(of(END).length, count);
});

test("a written parameter of the bow is reported at once, later as it moves", async () => {
  const { player, sink } = await playing({ target: () => 0.25 });
  assert.equal(player.value("/bow/speed"), 0.25);
  player.write("/bow/speed", 0.1);
  player.draw(0.2, 1);
  assert.equal(player.value("/bow/speed"), 0.2);
  assert.equal(player.value("/bow/assist"), 0);
  sink.frame += RATE;
  assert.equal(player.value("/bow/speed"), 0.25);
});

test("a written force of the bow is heard without assist", async () => {
  const { player } = await playing({ target: () => 0.25 });
  player.write("/bow/force", 1);
  assert.equal(player.value("/bow/assist"), 0);
});

test("with others the value they set counts, but one just written here is reported at once", async () => {
  const set = { [LOUDNESS]: 0.8 };
  const { player, sink } = await playing({ reported: (address) => set[address] });
  assert.equal(player.value(LOUDNESS), 0.8);
  player.write(LOUDNESS, 0.6);
  assert.equal(player.value(LOUDNESS), 0.6);
  sink.frame += RATE;
  assert.equal(player.value(LOUDNESS), 0.8);
});

test("a soft control waits for the value that others set", async () => {
  const set = { [LOUDNESS]: 0.2 };
  const { player, sink, values } = await playing({ reported: (address) => set[address] });
  player.remap(merged(MAPPINGS.keyboard, [bindOf(LOUDNESS, "cc 74", true)]));
  sink.frame += RATE;
  for (const position of [120, 100]) player.midi([0xb0, 74, position]);
  assert.ok(values(WRITE, LOUDNESS).every((value) => value === 0.2));
  player.midi([0xb0, 74, 20]); // passes 0.2
  assert.equal(values(WRITE, LOUDNESS).at(-1), 20 / 127);
});

test("how many play a section is as the server can, and no more than one here", async () => {
  const here = await playing();
  here.player.write(SECTION, 5);
  assert.equal(here.player.value(SECTION), 1);
  const there = await playing({ maxPlayers: Infinity });
  there.player.write(SECTION, 5.4);
  assert.equal(there.player.value(SECTION), 5);
  there.player.fingerOn("hand", 70, 0.5);
  assert.deepEqual(there.values(WRITE, SECTION), [5]);
  assert.deepEqual(there.values(EXPRESS, SECTION), []);
  there.player.remap(merged(MAPPINGS.keyboard, [bindOf(SECTION, "cc 74", false)]));
  there.player.midi([0xb0, 74, 127]);
  assert.equal(there.values(WRITE, SECTION).at(-1), 16);
  assert.equal(there.player.value(SECTION), 16);
});

test("a control with smoothing is not undone by the next note", async () => {
  const { player, values, of } = await playing();
  const { binds, ...mapping } = MAPPINGS.keyboard;
  const smoothed = binds.map((bind) =>
    bind.target === LOUDNESS ? { ...bind, row: { ...bind.row, smoothing_ms: 20 } } : bind,
  );
  player.remap({ ...mapping, binds: smoothed });
  player.midi([0xb0, 11, 38]);
  const written = of(WRITE).at(-1);
  assert.deepEqual([written.value, written.other], [38 / 127, 20]);
  player.midi([0x90, 70, 90]);
  assert.equal(values(EXPRESS, LOUDNESS).at(-1), 38 / 127);
  assert.equal(player.value(LOUDNESS), 38 / 127);
});

test("whatever events come, each comes to an end, and all commands are finite", async () => {
  const interpreter = await Interpreter.open(module);
  const player = new Player({ post() {} });
  player.playBy(interpreter);
  let seed = 1;
  const chance = (most) => (seed = (seed * 16807) % 2147483647) % most;
  const WILD = [NaN, Infinity, -Infinity, 1e308, -1e308, 1e-308, 0, -1];
  const kinds = Object.keys(facts.kinds).length + Object.keys(facts.events).length;
  for (let step = 0; step < (EVERYTHING ? 100_000 : 20_000); step += 1) {
    const [value, other] = [0, 1].map(() =>
      chance(20) ? chance(1280) / 10 : WILD[chance(WILD.length)],
    );
    const isMessage = chance(2) === 0;
    const bytes = 0x80 + chance(0x80) + (chance(130) << 8) + chance(130) * 2 ** 16;
    const index = isMessage
      ? bytes + 3 * 2 ** 24 + chance(17) * 2 ** 32
      : chance(chance(9) ? 100 : 2e9) - 5;
    const kind = isMessage ? facts.events.MESSAGE : chance(kinds);
    const commands = interpreter.take(chance(1e6) - 1000, kind, index, value, other);
    if (kind >= Object.keys(facts.kinds).length) assert.ok(commands.flat().every(Number.isFinite));
  }
});

test("what does not exist or is no number is refused, and changes nothing", async () => {
  const { player, commands } = await playing();
  const count = commands.length;
  const refused = [
    () => player.write("/playing/nothing", 1),
    () => player.write("/playing/vibrato", NaN),
    () => player.value("/nothing"),
    () => player.fingerOn("hand", 128, 0.5),
    () => player.fingerOn("hand", 70, NaN),
    () => player.slide(-1),
    () => player.applyPreset("nothing"),
    () => player.applyPreset("constructor"),
    () => player.applyTuning("nothing"),
  ];
  for (const call of refused) assert.throws(call, ParameterError);
  assert.equal(commands.length, count);
});

test("a preset sets what it names", async () => {
  const { player } = await playing();
  player.applyPreset("flautando");
  const { values } = facts.presets.shipped.flautando;
  for (const [address, value] of Object.entries(values)) assert.equal(player.value(address), value);
});

test("without an interpreter only silence can be requested, and what was chosen waits for it", async () => {
  const commands = [];
  const player = new Player({ post: (...command) => commands.push(command) });
  player.fingerOn("hand", 70, 0.5);
  player.write(LOUDNESS, 0.5);
  player.applyTuning("chaozhou-seven-equal");
  player.remap(MAPPINGS.wind);
  player.panic();
  assert.deepEqual(commands, [[null, STOP, 0, 1, 0]]);
  assert.equal(player.value(LOUDNESS), facts.parameters[INDEX[LOUDNESS]].default);
  player.playBy(await Interpreter.open(module));
  player.midi([0xb0, 2, 127]); // a breath controller
  player.midi([0x90, 67, 90]);
  const [, , , , pitch] = commands.find(([, kind]) => kind === BEGIN);
  assert.equal(pitch, facts.tunings["chaozhou-seven-equal"].keys[67]);
  assert.ok(commands.length > 5);
});
