/**
 * Lets the sounding note follow the controllers of its channel, through a mapping.
 *
 * Moves on a channel affect its notes, or all notes (`scope.js`): while one of them sounds, and
 * after it until a note of another channel begins.
 */

import facts from '../facts.js';
import { DefaultMap } from './default_map.js';
import { keyOf } from './keys.js';
import { Moves } from './moves.js';
import { clamp, roundHalfEven } from './numbers.js';
import { FINEST, NOTE, POLY_PRESSURE, STEPS, VELOCITY } from './sources.js';
import { TABLE, find } from './table.js';
import { TargetValues } from './target_values.js';

// "Reset all controllers" leaves volume; wheel and aftertouch spring back when the hand lets go.
const { KEPT_ON_RESET, SPRUNG, FINE_BITS } = facts.controllers;

/**
 * @typedef {import('./binds.js').Bind} Bind
 * @typedef {import('./keys.js').Key} Key
 * @typedef {import('./mapping.js').Mapping} Mapping
 * @typedef {import('./target_values.js').Values} Values
 *
 * @typedef {object} Fader State of one bind of an address; it belongs to no channel.
 * @property {number | null} position
 * @property {number | null} written the value it last gave its target
 */

/** Writes the values of moved controllers. */
export class Controllers {
  #wishes;
  #rules;
  #scope;
  #start;
  #moves = new Moves();
  #values;
  /** @type {DefaultMap<string, Fader>} */
  #faders = new DefaultMap(() => ({ position: null, written: null }));

  /**
   * @param {import('./wishes.js').Wishes} wishes
   * @param {Mapping} mapping
   * @param {import('./scope.js').ChannelRules} rules
   * @param {import('./scope.js').Scope} scope
   * @param {Iterable<readonly [string, number]>} start values over those of the mapping
   */
  constructor(wishes, mapping, rules, scope, start = []) {
    this.#wishes = wishes;
    this.#rules = rules;
    this.#scope = scope;
    this.#start = new Map(start);
    this.#values = new TargetValues(wishes, mapping, this.#moves, rules, scope);
  }

  /** The mapping in use; `remap` takes another. */
  get mapping() {
    return this.#values.mapping;
  }

  // -- moves -------------------------------------------------------------------------------

  /**
   * Move a source of a channel to a position, 0 to 1.
   * @param {string} source
   * @param {number} channel
   * @param {number} position
   * @param {number | null} frame
   */
  move(source, channel, position, frame) {
    const binds = this.#receiving(source, channel);
    if (binds.length === 0) return;
    this.#values.keepOf(source);
    const own = this.#moves.on(channel);
    const move = this.#moves.to(position);
    for (const bind of binds) {
      if (bind.isSoft && this.#takesOver(bind, channel, position)) own.soft.set(bind.key, move);
    }
    own.sources.set(source, move);
    this.follow(source, channel, frame, binds);
  }

  /**
   * Move a 14-bit source by its coarse half, 0 to 127; the fine half is set to 0.
   * @param {string} source
   * @param {number} channel
   * @param {number} value
   * @param {number | null} frame
   */
  moveCoarse(source, channel, value, frame) {
    this.move(source, channel, (value << FINE_BITS) / FINEST, frame);
  }

  /**
   * Set the fine half, 0 to 127, of a source that `moveCoarse` moved.
   * @param {string} source
   * @param {number} channel
   * @param {number} value
   * @param {number | null} frame
   */
  moveFine(source, channel, value, frame) {
    const move = this.#moves.on(channel).sources.get(source);
    if (move === undefined) return;
    const coarse = roundHalfEven(move.position * FINEST) >> FINE_BITS;
    this.move(source, channel, ((coarse << FINE_BITS) | value) / FINEST, frame);
  }

  /**
   * Move a source by 127ths of its range, from its position or that of its target.
   * @param {string} source
   * @param {number} channel
   * @param {number} steps
   * @param {number | null} frame
   */
  step(source, channel, steps, frame) {
    const move = this.#moves.on(channel).sources.get(source);
    const [bind] = this.#receiving(source, channel);
    if (bind === undefined) return;
    const from = move?.position ?? bind.toUnit(this.#wishes.value(bind.target));
    this.move(source, channel, clamp(from + steps / STEPS, 0, 1), frame);
  }

  /**
   * The binds that receive a source on a channel; global ones only if it plays no notes.
   * @param {string} source
   * @param {number} channel
   * @returns {readonly Bind[]}
   */
  #receiving(source, channel) {
    const binds = this.mapping.of(source);
    if (binds.length === 0) return binds;
    const plays = this.#rules.plays(channel);
    return binds.filter((bind) => bind.receives(channel) && (plays || bind.isGlobal));
  }

  /**
   * Move the aftertouch of one key to a position, 0 to 1.
   * @param {Key} key
   * @param {number} position
   * @param {number | null} frame
   */
  movePolyPressure(key, position, frame) {
    const binds = this.mapping.of(POLY_PRESSURE);
    if (binds.length === 0) return;
    this.#moves.on(key.channel).polyPressure.set(key.note, this.#moves.to(position));
    this.follow(POLY_PRESSURE, key.channel, frame, binds);
  }

  /**
   * Move the targets of an address of the page's own, for all channels.
   * @param {string} address
   * @param {number} argument
   * @param {number | null} frame
   */
  moveAddress(address, argument, frame) {
    for (const bind of this.mapping.of(address)) {
      const position = bind.inputToUnit(argument);
      const fader = this.#faders.at(bind.key);
      const present = this.#wishes.value(bind.target);
      const isWaiting = bind.isSoft && present !== fader.written;
      const before = fader.position;
      fader.position = position;
      if (!isWaiting || bind.picksUp(position, before, present)) {
        const value = bind.fromUnit(position);
        fader.written = this.write(bind.target, value, frame, bind.smoothingMs);
      }
    }
  }

  /**
   * Set a parameter for all channels, until a controller moves it; see `Wishes.write`.
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   * @param {number} glideMs
   * @returns {number}
   */
  write(address, value, frame, glideMs = 0) {
    const accepted = this.#wishes.write(address, value, frame, glideMs);
    if (!find(address).owned) this.#values.set(address, accepted);
    return accepted;
  }

  // -- notes -------------------------------------------------------------------------------

  /**
   * Give a note that is about to begin its velocity; return what `cancelNote` needs.
   * @param {Key} key
   * @param {number} velocity
   * @returns {import('./moves.js').NoteMoves}
   */
  beginNote(key, velocity) {
    const own = this.#moves.on(key.channel);
    const before = own.beginNote(key.note, this.#moves.to(velocity));
    this.#values.keepOf(VELOCITY);
    this.#values.keepOf(NOTE);
    return before;
  }

  /**
   * The values of parameters for a note that begins, or sounds again.
   * @param {Key} key
   * @returns {Values}
   */
  valuesOf(key) {
    this.#values.lastKey = key;
    return this.#values.of(key.channel, key.note);
  }

  /**
   * Undo `beginNote` where the instrument does not have the note.
   * @param {Key} key
   * @param {import('./moves.js').NoteMoves} before
   */
  cancelNote(key, before) {
    this.#moves.on(key.channel).cancelNote(key.note, before);
  }

  // -- forgetting --------------------------------------------------------------------------

  /**
   * Act on "reset all controllers".
   * @param {number} channel
   * @param {number | null} frame
   */
  reset(channel, frame) {
    const own = this.#moves.on(channel);
    own.polyPressure.clear();
    for (const bind of this.mapping.binds) {
      if (!KEPT_ON_RESET.includes(bind.target)) {
        own.sources.delete(bind.source);
        own.soft.delete(bind.key);
      }
    }
    for (const source of this.mapping.sources) {
      if (source !== VELOCITY && source !== NOTE) this.follow(source, channel, frame);
    }
  }

  /**
   * Forget all moves on a channel.
   * @param {number} channel
   */
  forget(channel) {
    this.#moves.pop(channel);
  }

  /**
   * Forget the moves on a channel whose port is gone, but keep those for all notes.
   *
   * So a loose cable changes nothing, except that wheel and aftertouch spring back.
   * @param {number} channel
   * @param {number | null} frame
   */
  disconnect(channel, frame) {
    const own = this.#moves.pop(channel);
    const forAll = this.mapping.binds.filter(
      (bind) => own.sources.has(bind.source) && this.#scope.isForAll(channel, bind.isGlobal),
    );
    const kept = forAll.filter((bind) => !SPRUNG.includes(bind.source));
    if (kept.length > 0) this.#moves.put(channel, own.only(kept));
    for (const source of SPRUNG) {
      if (forAll.some((bind) => bind.source === source)) this.follow(source, channel, frame);
    }
  }

  /**
   * Forget the moves on all channels; targets go back to where they were before.
   * @param {number | null} frame
   */
  forgetAll(frame) {
    this.#moves.clear();
    for (const [address, value] of this.#values.written) this.#wishes.write(address, value, frame);
  }

  // -- the mapping -------------------------------------------------------------------------

  /**
   * Set parameters to the start values of the mapping and of the performance.
   * @param {number | null} frame
   */
  begin(frame) {
    for (const [address, value] of this.#startValues(this.mapping)) {
      this.write(address, value, frame);
    }
  }

  /**
   * Each bind, and the position (0 to 1) of its source, if that was ever moved.
   * @returns {[Bind, number | null][]}
   */
  positions() {
    return this.mapping.binds.map((bind) => [bind, this.#position(bind)]);
  }

  /** @param {Bind} bind */
  #position(bind) {
    const fader = this.#faders.get(bind.key);
    return fader === undefined ? this.#moves.position(bind) : fader.position;
  }

  /**
   * All parameters that the player does not move, without the velocity of one note.
   * @returns {Values}
   */
  sound() {
    const values = new Map();
    for (const param of TABLE) {
      if (!param.owned) values.set(param.address, this.#wishes.value(param.address));
    }
    const written = this.#values.written;
    for (const { target } of this.mapping.of(VELOCITY)) {
      if (written.has(target)) values.set(target, written.get(target));
    }
    return values;
  }

  /**
   * Take another mapping; moves stay where their source is still bound.
   *
   * A parameter whose start value differs takes the new one, unless it was moved since.
   * @param {Mapping} mapping
   * @param {number | null} frame
   */
  remap(mapping, frame) {
    const before = this.mapping;
    this.#moves.remap(before, mapping);
    const [start, newStart] = [this.#startValues(before), this.#startValues(mapping)];
    let changed = this.#values.remap(mapping, start, newStart);
    const key = this.#values.lastKey;
    if (key !== null) changed = this.#values.of(key.channel, key.note);
    for (const [address, value] of changed) this.#wishes.write(address, value, frame);
  }

  /**
   * @param {Mapping} mapping
   * @returns {Values}
   */
  #startValues(mapping) {
    return new Map([...mapping.start, ...this.#start]);
  }

  // -- the sounding note -------------------------------------------------------------------

  /**
   * Write the targets of a source that was moved on a channel.
   * @param {string} source
   * @param {number} channel
   * @param {number | null} frame
   * @param {readonly Bind[]} moved the binds whose smoothing applies
   */
  follow(source, channel, frame, moved = []) {
    this.#values.keepOf(source);
    const key = this.#wishes.sounding ?? this.#values.lastKey;
    let binds = this.mapping.of(source);
    if (key !== null) binds = binds.filter((bind) => this.#values.isFor(bind, channel, key));
    if (binds.length === 0) return;
    const values = this.#values.of(key?.channel ?? channel, key?.note ?? -1);
    for (const { target } of binds) {
      const value = values.get(target);
      if (value === undefined) throw new Error(`${target} was not kept`);
      this.#wishes.write(target, value, frame, glideOf(target, moved));
    }
  }

  /**
   * Whether a soft bind moves its target: it set its present value, or reaches it now.
   * @param {Bind} bind
   * @param {number} channel
   * @param {number} position
   * @returns {boolean}
   */
  #takesOver(bind, channel, position) {
    const own = this.#moves.on(channel);
    const last = this.#wishes.sounding ?? this.#values.lastKey;
    const isFor = last !== null && this.#values.isFor(bind, channel, last);
    const key = isFor ? last : keyOf(channel, -1);
    const present = this.#values.of(key.channel, key.note).get(bind.target);
    if (present === undefined) throw new Error(`${bind.target} was not kept`);
    const soft = own.soft.get(bind.key);
    if (soft !== undefined && bind.fromUnit(soft.position) === present) return true;
    return bind.picksUp(position, own.sources.get(bind.source)?.position ?? null, present);
  }
}

/**
 * The smoothing of a target (ms): that of the last bind which moves it.
 * @param {string} target
 * @param {readonly Bind[]} binds
 * @returns {number}
 */
function glideOf(target, binds) {
  let glideMs = 0;
  for (const bind of binds) if (bind.target === target) glideMs = bind.smoothingMs;
  return glideMs;
}
