/** The names of sources: MIDI controllers, and properties of a note. */

import facts from "../facts.js";

/** The code of each, in tables; beside words, where those of pairs and of parameters begin. @type {Record<string, number>} */
const CODES = facts.codes;
const { PAIR, NRPN } = facts.codes;
export const [BEND, PRESSURE, POLY_PRESSURE] = ["bend", "pressure", "poly-pressure"];
export const { FINE_ABOVE, STEPS, FINEST, CHANNELS } = facts.sources;
const [FIRST_COARSE, LAST_COARSE] = facts.sources.COARSE;

// Made once: a name is looked up with every message.
const CONTROLS = Array.from({ length: STEPS + 1 }, (_, number) => `cc ${number}`);
const PAIRS = CONTROLS.map((name, number) => `${name}/${number + FINE_ABOVE}`);
const LEARNED = new Set([
  ...[BEND, PRESSURE, POLY_PRESSURE],
  ...CONTROLS.filter((_, number) => !facts.sources.RESERVED.includes(number)),
  ...PAIRS.filter((_, number) => isPair(number)),
]);

/** The source of a 7-bit control change. @param {number} number */
export const control = (number) => CONTROLS[number];

/**
 * The source of two control changes that make 14 bits, by the number of the coarse one.
 * @param {number} coarse
 */
export const pair = (coarse) => PAIRS[coarse];

/** The source of a non-registered parameter, 0 to 16382. @param {number} number */
export const nrpn = (number) => `nrpn ${number}`;

/** Whether a controller has a fine half, `FINE_ABOVE` higher. @param {number} number */
export function isCoarse(number) {
  return FIRST_COARSE <= number && number <= LAST_COARSE;
}

/** Whether a pair of this coarse half can be a source. @param {number} number */
function isPair(number) {
  const { RESERVED } = facts.sources;
  return isCoarse(number) && !RESERVED.includes(number) && !RESERVED.includes(number + FINE_ABOVE);
}

/**
 * The controller of a source: the same for a control change in 7 bits and in 14.
 * @param {string} source
 */
export const controller = (source) => (source.startsWith("cc ") ? source.split("/")[0] : source);

/**
 * Whether a value is the name of a source that can be learned.
 * @param {unknown} name
 * @returns {name is string}
 */
export function isSource(name) {
  const number = Number(/^nrpn (\d{1,5})$/.exec(String(name))?.[1]);
  if (number < facts.sources.NO_NRPN) return name === nrpn(number);
  return LEARNED.has(/** @type {string} */ (name));
}

/** Whether a source belongs to one note. @param {string} source */
export const isOfOneNote = (source) => facts.sources.OF_ONE_NOTE.includes(source);

/**
 * The code that tables have for a source.
 * @param {string} source
 * @returns {number}
 */
export function codeOf(source) {
  if (Object.hasOwn(CODES, source)) return CODES[source];
  const [kind, number] = source.split(" ");
  if (kind === "nrpn") return NRPN + Number(number);
  const [coarse, fine] = number.split("/");
  return (fine ? PAIR : 0) + Number(coarse);
}
