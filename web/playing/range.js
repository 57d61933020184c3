/** The range of the instrument. */

import facts from '../facts.js';
import { clamp } from './numbers.js';

const { LOWEST_NOTE, HIGHEST_NOTE, OPEN_WITHIN } = facts.notes;
const OCTAVE = 12;

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
