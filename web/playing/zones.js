/**
 * MPE zones: member channels of one note each, and a master channel for all of them.
 *
 * Source: MIDI Polyphonic Expression, version 1.0 (MIDI Association).
 */

import facts from '../facts.js';

const { LOWER_MASTER, UPPER_MASTER, MOST_MEMBERS, MEMBER_BEND, MASTER_BEND } = facts.zones;

/** The zones of one MIDI port: at first none, or one of all channels. */
export class Zones {
  #lower;
  #upper = 0;

  /** @param {boolean} whole */
  constructor(whole = false) {
    this.#lower = whole ? MOST_MEMBERS : 0;
  }

  /**
   * Act on an MPE configuration message; return whether the channel can be a master. Where two
   * zones overlap, the one configured last keeps its channels.
   * @param {number} channel
   * @param {number} wanted
   * @returns {boolean}
   */
  configure(channel, wanted) {
    const members = Math.min(wanted, MOST_MEMBERS);
    const room = Math.max(MOST_MEMBERS - 1 - members, 0); // between the two masters
    if (channel === LOWER_MASTER) {
      this.#lower = members;
      this.#upper = Math.min(this.#upper, room);
    } else if (channel === UPPER_MASTER) {
      this.#upper = members;
      this.#lower = Math.min(this.#lower, room);
    }
    return channel === LOWER_MASTER || channel === UPPER_MASTER;
  }

  /**
   * The master of a member channel; null for any other channel.
   * @param {number} channel
   * @returns {number | null}
   */
  master(channel) {
    if (LOWER_MASTER < channel && channel <= this.#lower) return LOWER_MASTER;
    if (UPPER_MASTER - this.#upper <= channel && channel < UPPER_MASTER) return UPPER_MASTER;
    return null;
  }

  /**
   * The member channels of a master; none for any other channel.
   * @param {number} channel
   * @returns {number[]}
   */
  members(channel) {
    if (channel === LOWER_MASTER) return Array.from({ length: this.#lower }, (_, n) => n + 1);
    if (channel !== UPPER_MASTER) return [];
    return Array.from({ length: this.#upper }, (_, n) => UPPER_MASTER - this.#upper + n);
  }

  /**
   * Default bend range of a channel (semitones); null outside all zones.
   * @param {number} channel
   * @returns {number | null}
   */
  bendRange(channel) {
    if (this.master(channel) !== null) return MEMBER_BEND;
    const isMaster =
      (channel === LOWER_MASTER && this.#lower > 0) || (channel === UPPER_MASTER && this.#upper > 0);
    return isMaster ? MASTER_BEND : null;
  }
}
