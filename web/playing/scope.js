/**
 * Which notes a move on a channel affects: those of the channel, or all.
 *
 * Moves are for all notes if their port has played no note, as of a box of pedals or faders, or if
 * their bind is global. But a member channel of an MPE zone belongs to one note, and so do its
 * moves.
 */

import { portOf } from './sources.js';

/**
 * What MIDI messages have set up for each channel, counted from 0 over all ports.
 * @typedef {object} ChannelRules
 * @property {(channel: number) => number | null} master of a member of an MPE zone; else null
 * @property {(channel: number) => number} bendRange semitones
 * @property {(channel: number) => boolean} plays whether its notes are played
 */

/** Keeps which ports have played notes, and tells which moves are for all notes. */
export class Scope {
  #rules;
  /** @type {Set<number>} */
  #keyboards = new Set();

  /** @param {ChannelRules} rules */
  constructor(rules) {
    this.#rules = rules;
  }

  /**
   * Record a note of a channel; return whether it is the first of its port.
   * @param {number} channel
   * @returns {boolean}
   */
  add(channel) {
    const port = portOf(channel);
    const isFirst = !this.#keyboards.has(port);
    this.#keyboards.add(port);
    return isFirst;
  }

  /**
   * Undo `add` where it returned true and the instrument does not have the note.
   * @param {number} channel
   */
  remove(channel) {
    this.#keyboards.delete(portOf(channel));
  }

  /**
   * Whether a move on a channel is for all notes.
   * @param {number} channel
   * @param {boolean} isGlobal whether its bind is
   * @returns {boolean}
   */
  isForAll(channel, isGlobal = false) {
    if (!isGlobal && this.#keyboards.has(portOf(channel))) return false;
    if (this.#rules.master(channel) !== null) return false;
    return isGlobal || this.#rules.plays(channel);
  }
}
