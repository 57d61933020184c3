/** The tuning, as hands meet it: which pitch a key has, and on which a finger lands. */

import facts from "../facts.js";
import { HIGHEST, LOWEST } from "./scale.js";

/** @typedef {import('../playing/tables.js').Tuning} Tuning */

export class KeyTuning {
  constructor() {
    /** @type {Record<string, Tuning>} */
    this.all = facts.tunings;
    /** @type {Tuning} */
    this.tuning = facts.tunings.equal;
    /** Pitches of the keys within the instrument's range. @type {number[]} */
    this.pitches = [];
    this.#collect();
  }

  /** @param {string} name of `facts.tunings` */
  choose(name) {
    this.tuning = this.all[name];
    this.#collect();
  }

  #collect() {
    this.pitches = [];
    for (let key = 0; key < facts.notes.KEYS; key++) {
      const found = this.pitchOf(key);
      if (found !== null && found > LOWEST - 0.5 && found < HIGHEST + 0.5) this.pitches.push(found);
    }
  }

  /**
   * The pitch of a key; null where it has none.
   * @param {number} key
   */
  pitchOf(key) {
    const { keys } = this.tuning;
    return keys === null ? key : (keys[key] ?? null);
  }

  /**
   * The nearest pitch that a key has.
   * @param {number} place pitch
   */
  nearest(place) {
    let best = place;
    let least = Infinity;
    for (const one of this.pitches) {
      if (Math.abs(one - place) < least) [least, best] = [Math.abs(one - place), one];
    }
    return best;
  }
}
