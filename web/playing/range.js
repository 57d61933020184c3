/** Ranges: of any number, and of the instrument. */

import facts from "../facts.js";

const { LOWEST_NOTE, HIGHEST_NOTE, OPEN_WITHIN } = facts.notes;
const OCTAVE = 12;

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
