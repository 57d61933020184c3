/** Arithmetic as Python has it, for negative numbers and for ties. */

/**
 * The largest whole number of times that `divisor`, which is positive, goes into a number.
 * @param {number} number
 * @param {number} divisor
 * @returns {number}
 */
export function floorDivide(number, divisor) {
  // Exact, where the quotient itself would be rounded.
  return Math.round((number - modulo(number, divisor)) / divisor);
}

/**
 * What remains of a number; never negative for a positive divisor.
 * @param {number} number
 * @param {number} divisor
 * @returns {number}
 */
export function modulo(number, divisor) {
  const rest = number % divisor;
  return rest < 0 ? rest + divisor : rest;
}

/**
 * The nearest whole number; of two equally near, the even one.
 * @param {number} number
 * @returns {number}
 */
export function roundHalfEven(number) {
  const below = Math.floor(number);
  const fraction = number - below;
  if (fraction === 0.5) return below % 2 === 0 ? below : below + 1;
  return fraction < 0.5 ? below : below + 1;
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
