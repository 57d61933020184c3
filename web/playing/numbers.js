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
