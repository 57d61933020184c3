/** Keeps what was played as a capture of the server's format, and plays such a file again. */

/** @typedef {import('./instrument.js').Instrument} Instrument */
/** @typedef {import('./instrument.js').Command} Command */

import facts from "./facts.js";
import { FREE, TABLE, find } from "./playing/table.js";
import { COMMAND } from "./sound/kernel.js";

const FORMAT = "yehu-server capture";
const VERSIONS = [2, 3]; // the former has one player, and no numbers of players
const OWN = 1; // the player of this page, and of a file the one that is played
const MAX_BYTES = 64 << 20;
const MAX_COMMANDS = 1e6;
const MAX_A_SECOND = 5000; // commands: two hands come to some hundreds
const LONGEST_S = 24 * 3600;
const EVERY = 60; // ms
const RINGS_S = 1; // after its last command
const { RAMP, WRITE, HOLD, EXPRESS, BEGIN, END, SLIDE, STOP, DRAW, RELEASE } = facts.kinds;
/** Kinds of commands, by their numbers. */
export const KINDS = Object.keys(facts.kinds);
const OF_SLOT = TABLE.filter(({ slot }) => slot !== null).map(({ address }) => address);
const SILENCE = "silence"; // in place of an engine's parameter

/** Kinds of commands whose index means a parameter. */
export const OF_PARAMETERS = [RAMP, WRITE, HOLD, EXPRESS];

/** The parameter of a command, which its index means; null where it means something else. @param {Command} command */
export function addressOf({ kind, index }) {
  if (kind === RAMP) return OF_SLOT[index] ?? SILENCE;
  return OF_PARAMETERS.includes(kind) ? TABLE[index].address : null;
}

/**
 * The index of a command of a parameter.
 * @param {number} kind
 * @param {string} address
 */
export function indexOf(kind, address) {
  if (kind !== RAMP) return find(address).index;
  return address === SILENCE ? OF_SLOT.length : OF_SLOT.indexOf(find(address).address);
}

/** Keeps the commands that a sound applies, which is able to. */
export class CaptureWriter {
  /** @param {import('./interfaces.js').Player} player @param {import('./interfaces.js').Sound} sound */
  constructor(player, sound) {
    this.player = player;
    this.sound = sound;
    /** @type {Record<string, number>} */
    this.values = {};
  }

  start() {
    this.values = Object.fromEntries(
      FREE.map(({ address }) => [address, this.player.value(address)]),
    );
    this.sound.keep?.start();
  }

  /**
   * End.
   * @returns {Promise<Performance & {frames: number}>}
   */
  async stop() {
    const { sound } = this;
    if (!sound.keep) throw new Error("nothing is kept");
    const { from, to, commands } = await sound.keep.stop();
    const rows = Array.from({ length: commands.length / COMMAND }, (_, i) => {
      const [frame, kind, index, value, other] = commands.slice(i * COMMAND, (i + 1) * COMMAND);
      return { frame: frame - from, kind, index, value, other };
    });
    return {
      rate: sound.status.rate,
      values: this.values,
      commands: rows.sort((one, other) => one.frame - other.frame),
      players: 1,
      frames: to - from,
    };
  }
}

/** A performance as a file. @param {Performance & {frames: number}} performance */
export async function fileOf({ rate, values, commands, frames }) {
  const answer = await fetch(new URL(`captures/${rate}.json`, import.meta.url));
  if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
  const head = await answer.json();
  Object.assign(head.players[OWN - 1].values, values);
  const lines = [head, ...commands.map(lineOf), { end: frames }];
  const text = lines.map((line) => `${JSON.stringify(line)}\n`);
  return new Blob(text, { type: "application/jsonl" });
}

/** @param {Command} command */
function lineOf(command) {
  const { frame, kind, index, value, other } = command;
  const line = [frame, OWN, KINDS[kind].toLowerCase()];
  const address = addressOf(command);
  if (address !== null) return [...line, address, value, ...(kind === EXPRESS ? [] : [other])];
  if (kind === BEGIN || kind === END) return [...line, index, value, other];
  if (kind === SLIDE || kind === STOP) return [...line, value];
  if (kind === DRAW) return [...line, value, other];
  return kind === RELEASE && value !== 0 ? [...line, value] : line;
}

/**
 * @typedef {object} Performance
 * @property {number} rate Hz
 * @property {Record<string, number>} values of parameters, at its beginning
 * @property {Command[]} commands of the first player, by frame
 * @property {number} players how many there are
 */

/**
 * Read a capture, of a page or a server; throws an error where it is none.
 * @param {Blob} file
 * @returns {Promise<Performance>}
 */
export async function readCapture(file) {
  if (file.size > MAX_BYTES) throw new RangeError("too large");
  const [head, ...lines] = (await file.text()).split("\n").filter((line) => line !== "");
  const { format, version, rate, ...begun } = JSON.parse(head);
  if (format !== FORMAT || !VERSIONS.includes(version) || !(rate >= 8000 && rate <= 384000)) {
    throw new TypeError("another format");
  }
  const isOld = version === VERSIONS[0];
  const players = isOld ? [begun] : begun.players;
  const { values } = players[OWN - 1];
  for (const [address, value] of Object.entries(values)) {
    find(address);
    finite(value);
  }
  const entries = lines.map((line) => JSON.parse(line)).filter(Array.isArray); // others are no commands
  const own = isOld ? entries : entries.filter(([, player]) => player === OWN);
  const commands = own.map(([frame, ...command]) =>
    commandOf([frame, ...command.slice(isOld ? 0 : 1)]),
  );
  return checked({
    rate,
    values: Object.fromEntries(
      Object.entries(values).filter(([address]) => !find(address).playerControlled),
    ),
    commands: commands.sort((one, other) => one.frame - other.frame),
    players: players.length,
  });
}

/**
 * A performance that came from elsewhere. Throws an error where it has more commands than anybody plays,
 * in all or in a second, or numbers that are none.
 * @param {Performance} performance
 */
export function checked(performance) {
  const { rate, values, commands } = performance;
  if (commands.length > MAX_COMMANDS) throw new RangeError("too many commands");
  Object.values(values).forEach(finite);
  let before = 0;
  commands.forEach(({ frame, value, other }, at) => {
    if (!(frame >= before && frame <= LONGEST_S * rate)) throw new RangeError(`frame ${frame}`);
    before = frame;
    finite(value);
    finite(other);
    const earlier = commands[at - MAX_A_SECOND];
    if (earlier && frame - earlier.frame < rate)
      throw new RangeError("too many commands at a time");
  });
  return performance;
}

/**
 * What is played of a performance that came from elsewhere: its notes and gestures. What it would hold would
 * outlive it, its ramps go past the player, and what is a server's own (`isServers`), its instrument, room and
 * output, is its owner's. It frees nothing that is held, and ends no notes of others at a server.
 * @param {Performance} performance
 * @param {boolean} isServers whether a server plays it
 * @returns {{played: Performance, leftOut: string[]}} and the addresses of what is left out
 */
export function notesAndGestures({ values, commands, ...rest }, isServers) {
  /** @param {import('./playing/table.js').Param} param */
  const isFree = ({ isOwnerOnly }) => !(isServers && isOwnerOnly);
  /** @param {Command} command */
  const isPlayed = ({ kind, index }) =>
    kind !== HOLD && kind !== RAMP && (!OF_PARAMETERS.includes(kind) || isFree(TABLE[index]));
  const played = {
    ...rest,
    values: Object.fromEntries(Object.entries(values).filter(([address]) => isFree(find(address)))),
    commands: commands.filter(isPlayed).map((command) => {
      if (command.kind === RELEASE) return { ...command, value: 1 };
      return command.kind === STOP && isServers ? { ...command, value: 0 } : command;
    }),
  };
  // A value that it has by itself brings nothing.
  const brought = Object.keys(values).filter(
    (address) => values[address] !== find(address).default,
  );
  const others = brought.filter((address) => !(address in played.values));
  const dropped = new Set(others);
  for (const command of commands) {
    const address = isPlayed(command) ? null : addressOf(command);
    if (address !== null && address !== SILENCE) dropped.add(address);
  }
  return { played, leftOut: [...dropped] };
}

/**
 * @param {unknown[]} line
 * @returns {Command}
 */
function commandOf([frame, name, ...rest]) {
  const kind = KINDS.indexOf(String(name).toUpperCase());
  if (kind < 0) throw new TypeError(`no ${name}`);
  /** @type {Command} */
  const command = { frame: finite(frame), kind, index: 0, value: 0, other: 0 };
  if (OF_PARAMETERS.includes(kind)) {
    command.index = indexOf(kind, String(rest.shift()));
  } else if (kind === BEGIN || kind === END) command.index = finite(rest.shift());
  [command.value, command.other] = [finite(rest[0] ?? 0), finite(rest[1] ?? 0)];
  return command;
}

/** @param {unknown} value */
function finite(value) {
  if (typeof value !== "number" || !Number.isFinite(value)) throw new TypeError(`${value}`);
  return value;
}

/** Plays a performance, in the sound that it brings; the one before is back at its end. Event: 'end'. */
export class Replayer extends EventTarget {
  /** @param {Instrument} instrument @param {Performance} performance */
  constructor(instrument, { rate, values, commands }) {
    super();
    this.instrument = instrument;
    this.commands = commands;
    this.next = 0;
    const own = instrument.sound?.status.rate ?? rate;
    this.ratio = own / rate;
    const { player } = instrument;
    const written = commands.filter(({ kind }) => kind === WRITE).map(({ index }) => TABLE[index]);
    const moved = [...Object.keys(values).map(find), ...written].filter((one) =>
      FREE.includes(one),
    );
    /** What is given back. @type {Map<string, number>} */
    this.before = new Map(moved.map(({ address }) => [address, player.value(address)]));
    this.begun = instrument.horizon;
    for (const [address, value] of Object.entries(values)) player.write(address, value, this.begun);
    this.latest = 0; // frame of the last command that was posted
    /** Notes that sound, by key. @type {Map<string, Command>} */
    this.open = new Map();
    this.timer = window.setInterval(() => this.#play(), EVERY);
  }

  #play() {
    for (; this.next < this.commands.length; this.next++) {
      const { frame, kind, index, value, other } = this.commands[this.next];
      const at = Math.round(this.begun + frame * this.ratio);
      if (at > this.instrument.horizon) return;
      this.#post(at, kind, index, value, other);
      this.latest = at;
    }
    const { frame, rate } = this.instrument;
    if (frame > this.latest + RINGS_S * rate) this.#end(frame);
  }

  /** @type {import('./interfaces.js').Post} */
  #post(frame, kind, index, value, other) {
    const key = `${index} ${value}`;
    if (kind === BEGIN) this.open.set(key, { frame: 0, kind: END, index, value, other: 0 });
    else if (kind === END) this.open.delete(key);
    // The player knows of what it sets: all that shows parameters shows what sounds.
    if (kind === WRITE) this.instrument.player.write(TABLE[index].address, value, frame, other);
    else this.instrument.post(frame, kind, index, value, other);
  }

  /** End only what this plays: somebody else plays on. */
  yield() {
    const at = Math.max(this.latest, this.instrument.frame);
    for (const { kind, index, value } of [...this.open.values()]) {
      this.#post(at, kind, index, value, 0);
    }
    this.#end(at);
  }

  /** End it early. */
  stop() {
    // After all that was posted already: a note among it would never end.
    const at = Math.max(this.latest, this.instrument.frame);
    this.instrument.player.panic(at);
    this.#end(at);
  }

  /** @param {number} at frame */
  #end(at) {
    clearInterval(this.timer);
    for (const [address, value] of this.before) this.instrument.player.write(address, value, at);
    this.dispatchEvent(new Event("end"));
  }
}
