/** The tuning, as hands meet it: which pitch a key has, and on which a finger lands. */

import facts from "../facts.js";
import { pitch } from "../playing/tuning.js";
import { HIGHEST, LOWEST } from "./scale.js";

/** @typedef {import('../playing/tuning.js').Tuning} Tuning */

const A4 = facts.tuning.STANDARD_A4;

export class Tuned {
  constructor() {
    /** @type {Record<string, Tuning>} */
    this.all = facts.tunings;
    /** @type {Tuning} */
    this.tuning = { name: "", keys: null, fixed: false };
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
    const [first, last] = facts.tuning.KEYS;
    this.pitches = [];
    for (let key = first; key <= last; key++) {
      const found = this.pitchOf(key);
      if (found !== null && found > LOWEST - 0.5 && found < HIGHEST + 0.5) this.pitches.push(found);
    }
  }

  /**
   * The pitch of a key; null where it has none.
   * @param {number} key
   */
  pitchOf(key) {
    return pitch(this.tuning, key, A4);
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
