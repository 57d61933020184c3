/** What happens to notes outside the range of the instrument. */

import facts from '../facts.js';
import { clamp, floorDivide } from './numbers.js';

const { LOWEST_NOTE, HIGHEST_NOTE, OPEN_WITHIN } = facts.notes;

/** @typedef {'transpose' | 'clamp' | 'skip'} RangePolicy */

/**
 * The note to play for a note, or null for none. A note that a tuning puts less than a quarter
 * tone out of range is moved to its end.
 * @param {RangePolicy} policy
 * @param {number} note
 * @returns {number | null}
 */
export function fit(policy, note) {
  const isNear = LOWEST_NOTE - OPEN_WITHIN < note && note < HIGHEST_NOTE + OPEN_WITHIN;
  if (isNear || policy === 'clamp') return clamp(note, LOWEST_NOTE, HIGHEST_NOTE);
  if (policy === 'skip') return null;
  if (note < LOWEST_NOTE) return note - 12 * floorDivide(note - LOWEST_NOTE, 12);
  return note + 12 * floorDivide(HIGHEST_NOTE - note, 12);
}
