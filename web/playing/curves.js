/** Curves, by which 0 to 1 is mapped to a range: by name, or given by points. */

import facts from '../facts.js';
import { clamp } from './numbers.js';

const { LIN, EXP, S } = facts.spec.CURVES;

/**
 * The name of a curve; or its points, joined by straight lines: [position of the source,
 * fraction of the span], both 0 to 1. Positions rise from 0 to 1.
 * @typedef {string | readonly (readonly number[])[]} Curve
 */

/**
 * Map `unit` in 0..1 to `lo`..`hi`; hi below lo inverts.
 * @param {Curve} curve
 * @param {number} unit
 * @param {number} lo
 * @param {number} hi
 * @returns {number}
 */
export function fromUnit(curve, unit, lo, hi) {
  if (typeof curve !== 'string') return lo + (hi - lo) * fractionAt(curve, unit);
  if (curve === EXP) return lo * (hi / lo) ** unit;
  const fraction = curve === S ? unit * unit * (3 - 2 * unit) : unit;
  return lo + (hi - lo) * fraction;
}

/**
 * Find the unit in 0..1 that `fromUnit` maps to a value, clamped to the range; of several, the
 * lowest.
 * @param {Curve} curve
 * @param {number} value
 * @param {number} lo
 * @param {number} hi
 * @returns {number}
 */
export function toUnit(curve, value, lo, hi) {
  if (typeof curve !== 'string') return positionOf(curve, fractionOf(curve, value, lo, hi));
  if (lo === hi) return 0;
  const within = clamp(value, Math.min(lo, hi), Math.max(lo, hi));
  if (curve === EXP) return Math.log(within / lo) / Math.log(hi / lo);
  const unit = (within - lo) / (hi - lo);
  return curve === S ? 0.5 - Math.sin(Math.asin(1 - 2 * unit) / 3) : unit;
}

/**
 * Fraction of the span at a position of the source, for a curve of points.
 * @param {readonly (readonly number[])[]} points
 * @param {number} position
 * @returns {number}
 */
export function fractionAt(points, position) {
  const beyond = points.findIndex((point) => point[0] > position);
  const after = clamp(beyond < 0 ? points.length : beyond, 1, points.length - 1);
  const [[x0, y0], [x1, y1]] = [points[after - 1], points[after]];
  return position >= x1 ? y1 : y0 + ((y1 - y0) * (position - x0)) / (x1 - x0);
}

/**
 * Fraction of the span at a value, clamped to the fractions that a curve of points reaches.
 * @param {readonly (readonly number[])[]} points
 * @param {number} value
 * @param {number} lo
 * @param {number} hi
 * @returns {number}
 */
export function fractionOf(points, value, lo, hi) {
  const fractions = points.map((point) => point[1]);
  return clamp(toUnit(LIN, value, lo, hi), Math.min(...fractions), Math.max(...fractions));
}

/**
 * The lowest position at which a curve of points has a fraction.
 * @param {readonly (readonly number[])[]} points
 * @param {number} fraction
 * @returns {number}
 */
function positionOf(points, fraction) {
  for (let after = 1; after < points.length; after += 1) {
    const [[x0, y0], [x1, y1]] = [points[after - 1], points[after]];
    if (y0 === fraction) return x0;
    if (Math.min(y0, y1) <= fraction && fraction <= Math.max(y0, y1)) {
      return x0 + ((x1 - x0) * (fraction - y0)) / (y1 - y0);
    }
  }
  return 1; // by rounding, past the last point
}
