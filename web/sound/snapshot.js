/** Reads a look at the instrument, numbers in the order of `facts.look`; and names the motion of its string. */

import facts from "../facts.js";
import { find } from "../playing/table.js";

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */

/** Points of a string's shape. */
export const POINTS = facts.look.shapes[1] / 2;
const LEAST_DB = -160;

/** Where each field begins. @type {Record<string, number>} */
const AT = Object.fromEntries(Object.entries(facts.look).map(([name, [at]]) => [name, at]));
const FINGERS = facts.look.finger_x[1];

/**
 * @param {Float64Array} look
 * @returns {Snapshot}
 */
export function snapshotOf(look) {
  const speed = Math.abs(look[AT.speed]);
  const beta = look[AT.beta];
  const string = /** @type {0 | 1 | -1} */ (look[AT.string]);
  const heard = look[AT.frequency] * 2 ** (look[AT.error] / 1200);
  return {
    frame: look[AT.frame],
    time: look[AT.frame] / look[AT.rate],
    pitch: look[AT.pitch],
    heard: { certainty: look[AT.certainty], errorCents: look[AT.error], slips: look[AT.slips] },
    level: look[AT.rms] > 0 ? Math.max(20 * Math.log10(look[AT.rms]), LEAST_DB) : LEAST_DB,
    shape: [shapeOf(look, 0), shapeOf(look, 1)],
    bow: { string, speed: look[AT.speed], force: look[AT.force], beta, x: look[AT.bow_x] },
    hair: { place: look[AT.hair_place], length: look[AT.hair_length] },
    fingers: fingersOf(look, string),
    period: 1 / heard,
    string: { length: look[AT.length] },
    schelleng: {
      min: (look[AT.lower] * speed) / beta ** 2,
      max: (look[AT.upper] * speed) / beta,
    },
  };
}

/**
 * The value that a parameter of bow and fingers has or moves to.
 * @param {Float64Array} look
 * @param {string} address
 */
export function targetOf(look, address) {
  const { slot } = find(address);
  return slot === null ? undefined : look[AT.targets + slot];
}

/** @param {Float64Array} look @param {number} string */
function shapeOf(look, string) {
  const start = AT.shapes + string * POINTS;
  return Float32Array.from(look.subarray(start, start + POINTS));
}

/**
 * The fingers that press; they stop both strings.
 * @param {Float64Array} look
 * @param {number} string
 */
function fingersOf(look, string) {
  const fingers = [];
  for (let i = 0; i < FINGERS; i++) {
    const press = look[AT.finger_press + i];
    if (press > 0) fingers.push({ x: look[AT.finger_x + i], press, string: Math.max(string, 0) });
  }
  return fingers;
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
