/** The parameter table: ranges, defaults and curves of all that can be set, by address. */

import facts from "../facts.js";

/** @typedef {typeof facts.parameters[number]} Param A row of the table. */

const { LOWEST_NOTE, HIGHEST_NOTE, OPEN_WITHIN } = facts.notes;
const OCTAVE = 12;

/** @type {readonly Param[]} */
export const TABLE = facts.parameters;
/** The parameters that may be set by anybody: the player moves the others itself. */
export const FREE = TABLE.filter(({ playerControlled }) => !playerControlled);
/** Their groups, in the order of their use. */
export const GROUPS = [
  ...new Set([
    ...["playing", "bow", "finger", "vibrato", "pluck", "string", "body", "room", "output"],
    ...TABLE.map(({ group }) => group),
  ]),
];
const BY_ADDRESS = new Map(TABLE.map((param) => [param.address, param]));

/** An address that does not exist, or a value that is no finite number. */
export class ParameterError extends Error {}

/**
 * Find the row of an address; throws ParameterError where there is none.
 * @param {string} address
 * @returns {Param}
 */
export function find(address) {
  const param = BY_ADDRESS.get(address);
  if (param === undefined) throw new ParameterError(`unknown parameter ${address}`);
  return param;
}

/**
 * Clamp a value to a parameter's range; throws ParameterError where it is no finite number.
 * @param {Param} param
 * @param {number} value
 * @returns {number}
 */
export function accept(param, value) {
  if (!Number.isFinite(value)) throw new ParameterError(`${param.address}: ${value} is not finite`);
  return clamp(value, param.lo, param.hi);
}

/**
 * Map 0..1, clamped, to a parameter's range along its curve.
 * @param {Param} param
 * @param {number} share
 */
export function fromUnit({ curve, lo, hi }, share) {
  const unit = clamp(share, 0, 1);
  if (curve === "exp") return lo * (hi / lo) ** unit;
  return lo + (hi - lo) * (curve === "s" ? unit * unit * (3 - 2 * unit) : unit);
}

/**
 * Map a value to 0..1, the inverse of `fromUnit`.
 * @param {Param} param
 * @param {number} value
 */
export function toUnit({ curve, lo, hi }, value) {
  const within = clamp(value, lo, hi);
  if (curve === "exp") return Math.log(within / lo) / Math.log(hi / lo);
  const unit = (within - lo) / (hi - lo);
  return curve === "s" ? 0.5 - Math.sin(Math.asin(1 - 2 * unit) / 3) : unit;
}

/**
 * A number, moved to the nearer end of a range if it lies outside.
 * @param {number} number
 * @param {number} lo
 * @param {number} hi
 * @returns {number}
 */
export function clamp(number, lo, hi) {
  return Math.min(Math.max(number, lo), hi);
}

/**
 * The note that is played for one that may be out of range: some octaves higher or lower.
 * @param {number} note
 * @returns {number}
 */
export function transposed(note) {
  const isNear = LOWEST_NOTE - OPEN_WITHIN < note && note < HIGHEST_NOTE + OPEN_WITHIN;
  if (isNear) return clamp(note, LOWEST_NOTE, HIGHEST_NOTE);
  if (note < LOWEST_NOTE) return note + OCTAVE * Math.ceil((LOWEST_NOTE - note) / OCTAVE);
  return note - OCTAVE * Math.ceil((note - HIGHEST_NOTE) / OCTAVE);
}
