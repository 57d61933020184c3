/**
 * The values that a mapping gives its targets, for each note.
 *
 * Of several sources of one target the one moved last counts; a direct write counts as a move.
 * Moves on a channel affect the notes of that channel, or all notes (`scope.js`).
 */

import { BEND, VELOCITY } from './sources.js';
import { find } from './table.js';

/**
 * @typedef {import('./binds.js').Bind} Bind
 * @typedef {import('./keys.js').Key} Key
 * @typedef {import('./mapping.js').Mapping} Mapping
 *
 * @typedef {object} Written A value of a target.
 * @property {number} number that of the move or write it comes from; 0: from none
 * @property {number} value
 *
 * @typedef {ReadonlyMap<string, number>} Values Values of parameters, by address.
 */

/** Computes the values of targets from moves and direct writes. */
export class TargetValues {
  #wishes;
  #moves;
  #rules;
  #scope;
  /**
   * Targets as `set` left them, or as they were before their first move.
   * @type {Map<string, Written>}
   */
  #written = new Map();

  /**
   * @param {import('./wishes.js').Wishes} wishes
   * @param {Mapping} mapping
   * @param {import('./moves.js').Moves} moves
   * @param {import('./scope.js').ChannelRules} rules
   * @param {import('./scope.js').Scope} scope
   */
  constructor(wishes, mapping, moves, rules, scope) {
    this.#wishes = wishes;
    /** The mapping in use. */
    this.mapping = mapping;
    this.#moves = moves;
    this.#rules = rules;
    this.#scope = scope;
    /** The key whose note sounds, or sounded last. @type {Key | null} */
    this.lastKey = null;
  }

  /**
   * Record a direct write.
   * @param {string} address
   * @param {number} value
   */
  set(address, value) {
    this.#written.set(address, { number: this.#moves.nextNumber(), value });
  }

  /**
   * Record the present values of a source's targets, before its first move.
   * @param {string} source
   */
  keepOf(source) {
    for (const bind of this.mapping.of(source)) this.#keep(bind.target);
  }

  /** @param {string} address */
  #keep(address) {
    if (!this.#written.has(address)) {
      this.#written.set(address, { number: 0, value: this.#wishes.value(address) });
    }
  }

  /** The values of targets without any moves. @returns {Values} */
  get written() {
    const values = new Map();
    for (const [address, written] of this.#written) values.set(address, written.value);
    return values;
  }

  /**
   * Take another mapping; return the start values that now apply.
   *
   * Those are the ones that differ between the two mappings (`before` and `after`), of parameters
   * that still have the old one.
   * @param {Mapping} mapping
   * @param {Values} before
   * @param {Values} after
   * @returns {Values}
   */
  remap(mapping, before, after) {
    this.mapping = mapping;
    for (const bind of mapping.binds) this.#keep(bind.target);
    const changed = new Map();
    for (const address of new Set([...before.keys(), ...after.keys()])) {
      const start = find(address).default;
      const [was, is] = [before.get(address) ?? start, after.get(address) ?? start];
      const now = this.#written.get(address)?.value ?? this.#wishes.value(address);
      if (was !== is && now === was) {
        this.#written.set(address, { number: 0, value: is }); // moves made before still count
        changed.set(address, is);
      }
    }
    return changed;
  }

  /**
   * Whether a bind's moves on a channel affect the note of a key.
   * @param {Bind} bind
   * @param {number} channel
   * @param {Key} key
   * @returns {boolean}
   */
  isFor(bind, channel, key) {
    if (channel === key.channel || channel === this.#rules.master(key.channel)) return true;
    return this.#scope.isForAll(channel, bind.isGlobal);
  }

  /**
   * The values of all targets that were ever moved, for a note of a channel.
   *
   * The latest counts of the write to a target, the channel's own moves, and the moves for all
   * notes. A note in an MPE zone has its master's moves where its channel has none. Bends add up:
   * that of the note's channel, of the master, and for all notes.
   * @param {number} channel
   * @param {number} note
   * @returns {Values}
   */
  of(channel, note) {
    const numbers = new Map();
    const values = new Map();
    for (const [address, written] of this.#written) {
      numbers.set(address, written.number);
      values.set(address, written.value);
    }
    const master = this.#rules.master(channel);
    const forAll = this.#channelsForAll(channel, false);
    const forAllByGlobal = this.mapping.hasGlobal ? this.#channelsForAll(channel, true) : forAll;
    for (const bind of this.mapping.binds) {
      let move = this.#moves.of(bind, channel, note);
      if (move === undefined && master !== null) move = this.#moves.of(bind, master, note);
      const otherChannel = this.#moves.latest(bind, bind.isGlobal ? forAllByGlobal : forAll);
      const other = otherChannel === null ? undefined : this.#moves.of(bind, otherChannel, -1);
      if (other !== undefined && (move === undefined || move.number < other.number)) move = other;
      if (move === undefined || move.number < (numbers.get(bind.target) ?? 0)) continue;
      let value = bind.fromUnit(move.position);
      if (bind.source === VELOCITY) {
        value *= this.#velocityFactor(bind.target);
      } else if (bind.isByRange) {
        value = this.#bend(bind, channel);
        for (const each of new Set([master, otherChannel])) {
          value += each === null ? 0 : this.#bend(bind, each);
        }
      }
      numbers.set(bind.target, move.number);
      values.set(bind.target, value);
    }
    return values;
  }

  /**
   * Other channels whose moves are for all notes.
   * @param {number} channel
   * @param {boolean} isGlobal whether the bind is
   * @returns {number[]}
   */
  #channelsForAll(channel, isGlobal) {
    if (this.lastKey === null) return []; // each move applies as it comes; a note sees them all
    const others = [];
    for (const other of [...this.#moves.channels]) {
      if (other !== channel && this.#scope.isForAll(other, isGlobal)) others.push(other);
    }
    return others;
  }

  /**
   * Ratio of a target's written value to its start value.
   *
   * Velocity comes with every note: without this factor a preset's value would last only until
   * the next note.
   * @param {string} target
   * @returns {number}
   */
  #velocityFactor(target) {
    const start = this.mapping.start.get(target) ?? find(target).default;
    const written = this.#written.get(target)?.value ?? start;
    return start > 0 ? written / start : 1;
  }

  /**
   * Bend of a channel (semitones).
   * @param {Bind} bind
   * @param {number} channel
   * @returns {number}
   */
  #bend(bind, channel) {
    if (!bind.receives(channel)) return 0;
    const position = this.#moves.on(channel).sources.get(BEND)?.position ?? 0.5;
    return bind.semitones(position, this.#rules.bendRange(channel));
  }
}
