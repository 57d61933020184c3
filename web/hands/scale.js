/** Where pitches are on the fingerboard, and what they are called. */

/** @typedef {import('../playing/tables.js').Tuning} Tuning */

import facts from "../facts.js";

/** The instrument's lowest and highest notes (MIDI), and its open strings. */
export const LOWEST = facts.notes.LOWEST_NOTE;
export const HIGHEST = facts.notes.HIGHEST_NOTE;
export const OPEN = facts.notes.OPEN;
/** Room beside the first and the last note, semitones. */
const MARGIN = 0.6;
/** Room for a semitone, px, for a finger and a mouse; where there is less, a part of the board is shown. */
const [FINGER, MOUSE] = [21, 16];
const coarse = globalThis.matchMedia?.("(pointer: coarse)");
const MIN_SHOWN = 8;

/** In F, the scale of the open strings, and in B flat these are no sharps. @type {Record<number, string>} */
const FLAT_NAMES = { 3: "E♭", 10: "B♭" };

const NAMES = facts.notes.NAMES.map((name) => name.replace("#", "♯"));

/** A note's letter with its octave. @param {number} pitch */
export function nameOf(pitch) {
  const note = Math.round(pitch);
  return letterOf(note) + (Math.floor(note / 12) - 1);
}

const MAJOR = [0, 2, 4, 5, 7, 9, 11];
const FLATS = [3, 10]; // steps that are lowered ones, not raised

/** The note that is do: at first the inner string. */
let tonic = OPEN[0];

/** @param {number | null} note that is do from now on; null: the inner string */
export function setTonic(note) {
  tonic = note ?? OPEN[0];
}

/** @param {number} note */
const stepOf = (note) => (((note - tonic) % 12) + 12) % 12;

/** Whether a note is one of the major scale on do. @param {number} note */
export function isDegree(note) {
  return MAJOR.includes(stepOf(note));
}

/**
 * A note as jianpu writes it: a digit with its sign, and the octaves above the first do, below it negative.
 * @param {number} note
 */
export function jianpu(note) {
  const step = stepOf(note);
  const isFlat = FLATS.includes(step);
  const degree = MAJOR.filter((one) => one <= step + Number(isFlat)).length;
  const sign = isDegree(note) ? "" : isFlat ? "♭" : "♯";
  return { digit: sign + degree, dots: Math.floor((note - tonic) / 12) };
}

/** The same in words, with dots above or below. @param {number} note */
export function jianpuText(note) {
  const { digit, dots } = jianpu(note);
  return digit + (dots < 0 ? "\u0323" : "\u0307").repeat(Math.abs(dots));
}

/** The string that a note is on, as it lies at hand. @param {number} note */
export function stringOf(note) {
  return note >= OPEN[1] ? 1 : 0;
}

/** Fingers by semitones above the open string, in the first position, and in those that follow. */
const FINGERS = [0, 1, 1, 2, 2, 3, 4, 4];

/**
 * The finger that stops a note, 1 to 4.
 * @param {number} note
 * @param {number} string
 */
export function fingerOf(note, string) {
  const above = Math.max(Math.round(note) - OPEN[string], 1);
  return FINGERS[above] ?? FINGERS[1 + ((above - FINGERS.length) % (FINGERS.length - 1))];
}

/** @param {number} note */
export function letterOf(note) {
  const step = ((note % 12) + 12) % 12;
  return FLAT_NAMES[step] ?? NAMES[step];
}

/** @param {number} note */
export function isNatural(note) {
  return NAMES[((note % 12) + 12) % 12].length === 1;
}

/** @param {number} pitch */
export function withinRange(pitch) {
  return Math.min(Math.max(pitch, LOWEST), HIGHEST);
}

/** The part of the range that is shown, on a line of some length. */
export class Scale {
  /** @param {number} length px @param {number} lowest note that should be shown first */
  constructor(length, lowest = LOWEST) {
    const whole = HIGHEST - LOWEST;
    const room = coarse?.matches ? FINGER : MOUSE;
    this.length = Math.max(length, 1);
    this.span = Math.min(whole, Math.max(MIN_SHOWN, Math.floor(length / room - 2 * MARGIN)));
    this.first = Math.min(Math.max(lowest, LOWEST), HIGHEST - this.span);
  }

  /** Whether some notes are not shown. */
  get isPart() {
    return this.span < HIGHEST - LOWEST;
  }

  /** @param {number} pitch */
  placeOf(pitch) {
    return ((pitch - this.first + MARGIN) / (this.span + 2 * MARGIN)) * this.length;
  }

  /** @param {number} place px */
  pitchAt(place) {
    return (place / this.length) * (this.span + 2 * MARGIN) + this.first - MARGIN;
  }
}

/**
 * A finger that lands in tune: at first on the nearest note, and from there as it slides. After
 * a semitone it is where the board says.
 */
export class Landing {
  /**
   * @param {number} place pitch where the finger touched the board
   * @param {number} nearest note of the tuning
   */
  constructor(place, nearest) {
    this.place = place;
    this.offset = nearest - place;
  }

  /** @param {number} place pitch where the finger is now */
  pitchAt(place) {
    return place + this.offset * Math.max(0, 1 - Math.abs(place - this.place));
  }
}

/** The tuning, as hands meet it: which pitch a key has, and on which a finger lands. */
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

  /** The pitch of a key; null where it has none. @param {number} key */
  pitchOf(key) {
    const { keys } = this.tuning;
    return keys === null ? key : (keys[key] ?? null);
  }

  /** The nearest pitch that a key has. @param {number} place pitch */
  nearest(place) {
    let best = place;
    let least = Infinity;
    for (const one of this.pitches) {
      if (Math.abs(one - place) < least) [least, best] = [Math.abs(one - place), one];
    }
    return best;
  }
}
