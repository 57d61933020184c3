/** Reads a snapshot, numbers in the order of `facts.snapshot`; and names the motion of its string. */

import facts from "../facts.js";
import { find } from "../playing/table.js";

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */

/** Points of a string's shape. */
export const POINTS = facts.snapshot.shapes[1] / 2;
const MIN_DB = -160;

/** Where each field begins. @type {Record<string, number>} */
const AT = Object.fromEntries(Object.entries(facts.snapshot).map(([name, [at]]) => [name, at]));
const FINGERS = facts.snapshot.finger_x[1];

/**
 * @param {Float64Array} numbers
 * @returns {Snapshot}
 */
export function snapshotOf(numbers) {
  const speed = Math.abs(numbers[AT.speed]);
  const beta = numbers[AT.beta];
  const string = /** @type {0 | 1 | -1} */ (numbers[AT.string]);
  const heard = numbers[AT.frequency] * 2 ** (numbers[AT.error] / 1200);
  return {
    frame: numbers[AT.frame],
    time: numbers[AT.frame] / numbers[AT.rate],
    pitch: numbers[AT.pitch],
    heard: {
      certainty: numbers[AT.certainty],
      errorCents: numbers[AT.error],
      slips: numbers[AT.slips],
    },
    level: numbers[AT.rms] > 0 ? Math.max(20 * Math.log10(numbers[AT.rms]), MIN_DB) : MIN_DB,
    shape: [shapeOf(numbers, 0), shapeOf(numbers, 1)],
    bow: { string, speed: numbers[AT.speed], force: numbers[AT.force], beta, x: numbers[AT.bow_x] },
    hair: { place: numbers[AT.hair_place], length: numbers[AT.hair_length] },
    fingers: fingersOf(numbers, string),
    period: 1 / heard,
    string: { length: numbers[AT.length] },
    schelleng: {
      min: (numbers[AT.lower] * speed) / beta ** 2,
      max: (numbers[AT.upper] * speed) / beta,
    },
  };
}

/**
 * The value that a parameter of bow and fingers has or moves to.
 * @param {Float64Array} numbers
 * @param {string} address
 */
export function targetOf(numbers, address) {
  const { slot } = find(address);
  return slot === null ? undefined : numbers[AT.targets + slot];
}

/** @param {Float64Array} numbers @param {number} string */
function shapeOf(numbers, string) {
  const start = AT.shapes + string * POINTS;
  return Float32Array.from(numbers.subarray(start, start + POINTS));
}

/**
 * The fingers that press; they stop both strings.
 * @param {Float64Array} numbers
 * @param {number} string
 */
function fingersOf(numbers, string) {
  const fingers = [];
  for (let i = 0; i < FINGERS; i++) {
    const press = numbers[AT.finger_press + i];
    if (press > 0)
      fingers.push({ x: numbers[AT.finger_x + i], press, string: Math.max(string, 0) });
  }
  return fingers;
}

/**
 * The string of the note: the bowed one; of a plucked note the one on which its finger stops its pitch; -1 in silence.
 * @param {Snapshot} state
 */
export function playedString({ bow, pitch, fingers, string: { length } }) {
  if (bow.string >= 0 || Number.isNaN(pitch)) return bow.string;
  const stop = fingers.reduce((farthest, { x }) => Math.max(farthest, x), 0);
  const off = facts.notes.OPEN.map((open) =>
    Math.abs(open - 12 * Math.log2(1 - stop / length) - pitch),
  );
  return off[0] < off[1] ? 0 : 1;
}

/** From here on a motion repeats itself well enough to be a tone. */
const CERTAIN = 0.8;
const FAINT = -70; // dBFS; below is silence
const TWICE = 1.5; // slips in a period; from here on the string slips too often

/**
 * The regime of the string: its motion, from what the ear hears.
 * @param {Snapshot} state
 * @returns {'silent' | 'ringing' | 'unheard' | 'helmholtz' | 'slipping' | 'raucous' | 'settling'}
 */
export function regimeOf({ bow, heard, level, schelleng }) {
  if (bow.string < 0 || bow.speed === 0) return level > FAINT ? "ringing" : "silent";
  if (heard.certainty === 0) return "unheard";
  if (heard.certainty >= CERTAIN) return heard.slips < TWICE ? "helmholtz" : "slipping";
  if (Math.abs(bow.force) > schelleng.max) return "raucous";
  return heard.slips >= TWICE ? "slipping" : "settling";
}

/**
 * The pitch that sounds, as far as it is heard: a fractional MIDI note, or NaN.
 * @param {Snapshot} state
 */
export function soundingPitch({ pitch, heard }) {
  return pitch + (heard.certainty >= CERTAIN ? heard.errorCents / 100 : 0);
}

const STEADY = 0.6; // s: some turns of a vibrato
const OTHER_NOTE = 0.5; // semitones

/** The pitch that sounds, as a tuner reads it: the mean over some turns of its vibrato. */
export class SteadyPitch {
  /** NaN for silence. */
  pitch = NaN;
  /** @type {{time: number, pitch: number}[]} of one note */
  #heard = [];

  /** @param {number} pitch now @param {number} time s */
  take(pitch, time) {
    const isSame = Math.abs(pitch - this.pitch) < OTHER_NOTE;
    const heard = isSame ? this.#heard.filter((one) => one.time > time - STEADY) : [];
    this.#heard = [...heard, { time, pitch }];
    this.pitch = this.#heard.reduce((sum, one) => sum + one.pitch, 0) / this.#heard.length;
  }
}
