/** The parameter table: ranges, defaults and curves of all that can be set, by address. */

import facts from "../facts.js";
import * as curves from "./curves.js";
import { clamp } from "./range.js";

/** @typedef {typeof facts.parameters[number]} Param A row of the table. */

/** @type {readonly Param[]} */
export const TABLE = facts.parameters;
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
 * @param {number} unit
 * @returns {number}
 */
export function fromUnit(param, unit) {
  return curves.fromUnit(param.curve, clamp(unit, 0, 1), param.lo, param.hi);
}

/**
 * Map a value to 0..1, the inverse of `fromUnit`.
 * @param {Param} param
 * @param {number} value
 * @returns {number}
 */
export function toUnit(param, value) {
  return curves.toUnit(param.curve, value, param.lo, param.hi);
}
