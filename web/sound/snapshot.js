/** Reads a look at the instrument: numbers in the order of `facts.look`. */

import facts from "../facts.js";

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */

/** Points of a string's shape. */
export const POINTS = facts.look.shapes[1] / 2;
const LEAST_DB = -160;

/** Where each field begins. @type {Record<string, number>} */
const AT = Object.fromEntries(Object.entries(facts.look).map(([name, [at]]) => [name, at]));
const FINGERS = facts.look.finger_x[1];

/** Parameters by address, in the order of the engine. @type {Map<string, number>} */
const SLOTS = new Map(
  facts.parameters.flatMap(({ address, slot }) => (slot === null ? [] : [[address, slot]])),
);

/**
 * @param {Float64Array} seen
 * @returns {Snapshot}
 */
export function snapshotOf(seen) {
  const speed = Math.abs(seen[AT.speed]);
  const beta = seen[AT.beta];
  const string = /** @type {0 | 1 | -1} */ (seen[AT.string]);
  const heard = seen[AT.frequency] * 2 ** (seen[AT.error] / 1200);
  return {
    frame: seen[AT.frame],
    time: seen[AT.frame] / seen[AT.rate],
    pitch: seen[AT.pitch],
    heard: { certainty: seen[AT.certainty], errorCents: seen[AT.error], slips: seen[AT.slips] },
    level: seen[AT.rms] > 0 ? Math.max(20 * Math.log10(seen[AT.rms]), LEAST_DB) : LEAST_DB,
    shape: [shapeOf(seen, 0), shapeOf(seen, 1)],
    bow: { string, speed: seen[AT.speed], force: seen[AT.force], beta, x: seen[AT.bow_x] },
    hair: { place: seen[AT.hair_place], length: seen[AT.hair_length] },
    fingers: fingersOf(seen, string),
    period: 1 / heard,
    string: { length: seen[AT.length] },
    schelleng: {
      min: (seen[AT.lower] * speed) / beta ** 2,
      max: (seen[AT.upper] * speed) / beta,
    },
  };
}

/**
 * The value that a parameter of bow and fingers has or moves to.
 * @param {Float64Array} seen
 * @param {string} address
 */
export function targetOf(seen, address) {
  const slot = SLOTS.get(address);
  return slot === undefined ? undefined : seen[AT.targets + slot];
}

/**
 * @param {Float64Array} seen
 * @param {number} string
 */
function shapeOf(seen, string) {
  const start = AT.shapes + string * POINTS;
  return Float32Array.from(seen.subarray(start, start + POINTS));
}

/**
 * The fingers that press; they stop both strings.
 * @param {Float64Array} seen
 * @param {number} string
 */
function fingersOf(seen, string) {
  const fingers = [];
  for (let i = 0; i < FINGERS; i++) {
    const press = seen[AT.finger_press + i];
    if (press > 0) fingers.push({ x: seen[AT.finger_x + i], press, string: Math.max(string, 0) });
  }
  return fingers;
}
