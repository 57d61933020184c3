/** Tunings: the pitch of each key, from Scala files that the server has read. */

import facts from '../facts.js';

const [FIRST_KEY, LAST_KEY] = facts.tuning.KEYS;
const { STANDARD_A4 } = facts.tuning;

/**
 * A tuning as `facts.tunings` have it.
 * @typedef {object} Tuning
 * @property {string} name
 * @property {readonly (number | null)[] | null} keys pitches of keys 0 to 127 (fractional MIDI
 *   notes; null for an unmapped key), relative to A4; null where each key sounds its own number
 * @property {boolean} fixed whether pitches are relative to an A4 of 440 Hz, whatever A4 is
 */

/**
 * The pitch of a key as a fractional MIDI note relative to `a4` (Hz). A fractional note is
 * interpolated between the mapped keys below and above. Null for an unmapped key, and beyond the
 * outermost mapped keys.
 * @param {Tuning} tuning
 * @param {number} note
 * @param {number} a4
 * @returns {number | null}
 */
export function pitch(tuning, note, a4) {
  const keys = tuning.keys;
  if (keys === null) return note;
  if (!(FIRST_KEY <= note && note <= LAST_KEY)) return null; // also refuses NaN
  let below = Math.floor(note);
  let above = Math.ceil(note);
  if (below !== above) {
    while (below > FIRST_KEY && keys[below] === null) below -= 1;
    while (above < LAST_KEY && keys[above] === null) above += 1;
  }
  let low = keys[below];
  const high = keys[above];
  if (low === null || high === null) return null;
  if (below !== above) low += ((high - low) * (note - below)) / (above - below);
  return tuning.fixed ? low - 12 * Math.log2(a4 / STANDARD_A4) : low;
}
