/** Curves, by which 0 to 1 is mapped to a range. */

import { clamp } from "./range.js";

/** @typedef {string} Curve Its name: 'lin', 'exp' or 's'. */

/**
 * Map `unit` in 0..1 to `lo`..`hi`.
 * @param {Curve} curve
 * @param {number} unit
 * @param {number} lo
 * @param {number} hi
 * @returns {number}
 */
export function fromUnit(curve, unit, lo, hi) {
  if (curve === "exp") return lo * (hi / lo) ** unit;
  const fraction = curve === "s" ? unit * unit * (3 - 2 * unit) : unit;
  return lo + (hi - lo) * fraction;
}

/**
 * Find the unit in 0..1 that `fromUnit` maps to a value, clamped to the range.
 * @param {Curve} curve
 * @param {number} value
 * @param {number} lo
 * @param {number} hi
 * @returns {number}
 */
export function toUnit(curve, value, lo, hi) {
  const within = clamp(value, lo, hi);
  if (curve === "exp") return Math.log(within / lo) / Math.log(hi / lo);
  const unit = (within - lo) / (hi - lo);
  return curve === "s" ? 0.5 - Math.sin(Math.asin(1 - 2 * unit) / 3) : unit;
}
