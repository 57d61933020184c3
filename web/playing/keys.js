/** Keys, by which held notes are told apart. */

/**
 * A held note's channel and key. `channel` is any number that distinguishes sources; `note` may be
 * fractional. Equal keys are one object, made by `keyOf`.
 * @typedef {object} Key
 * @property {number} channel
 * @property {number} note
 */

/** @type {Map<number, Map<number, Key>>} */
const known = new Map();

/**
 * The key of a channel and note.
 * @param {number} channel
 * @param {number} note
 * @returns {Key}
 */
export function keyOf(channel, note) {
  let ofChannel = known.get(channel);
  if (ofChannel === undefined) known.set(channel, (ofChannel = new Map()));
  let key = ofChannel.get(note);
  if (key === undefined) ofChannel.set(note, (key = Object.freeze({ channel, note })));
  return key;
}
