/** The notes of a tune; and which string and finger the player takes for them, as the server's `fingering.choose`. */

/** @typedef {import('../interfaces.js').Player} Player */
/** @typedef {import('../tune.js').Tune} Tune */

import facts from "../facts.js";
import { transposed } from "../playing/table.js";
import { OPEN, fingerOf } from "./scale.js";

const { OPEN_WITHIN, HIGHEST, SLOW_FROM_S, LEAST_PRESS, NODES } = facts.notes;
const ON_OPEN = -1; // place of a finger that is up
const NOTE_ON = 0x90;
const NOTE_OFF = 0x80;
const PERCUSSION = 9;
const OVERLAP = 0.001; // s; notes that overlap by more are in one bow

/**
 * @typedef {object} Note
 * @property {number} at s
 * @property {number} until s
 * @property {number} pitch
 * @property {boolean} isTied in one bow with the next
 *
 * @typedef {object} Fingered
 * @property {0 | 1} string
 * @property {number} finger 0: the string is open
 */

/** What the choice depends on, besides the notes. @param {Player} player */
export function habitsOf(player) {
  const rocks = player.value("/playing/vibrato") > 0;
  const presses = player.value("/playing/vibrato_press") >= LEAST_PRESS;
  const isPlucked = player.value("/playing/pizzicato") >= 0.5;
  const string = Math.round(player.value("/playing/string")) - 1;
  const number = Math.round(player.value("/playing/articulation"));
  const own = facts.articulations[number] ?? facts.articulations[0];
  const isStill = isPlucked || own.isPlucked || own.beats;
  return { shakes: !isStill && (own.shakes ?? (rocks || presses)), string, own };
}

/**
 * The fingering of notes, one after another.
 * @param {Note[]} notes
 * @param {ReturnType<typeof habitsOf>} habits `string`: that is asked for; -1: either; `own`: articulation
 * @param {number} pace
 * @returns {Fingered[]}
 */
export function fingered(notes, habits, pace) {
  let [string, place] = [-1, ON_OPEN];
  return notes.map(({ at, pitch }, i) => {
    const isSlow = i === 0 || at - notes[i - 1].at >= SLOW_FROM_S * pace;
    [string, place] = sliding(pitch, habits, isSlow, string, place);
    const own = /** @type {0 | 1} */ (string);
    return { string: own, finger: place === ON_OPEN ? 0 : fingerOf(pitch, own) };
  });
}

const placeOf = (/** @type {number} */ pitch, /** @type {number} */ string) =>
  1 - 2 ** ((OPEN[string] - pitch) / 12);

/**
 * As `choose`, of an articulation: where a finger slides, on the string that has all of the slide, or touches a node.
 * @param {number} pitch
 * @param {ReturnType<typeof habitsOf>} habits
 * @param {boolean} isSlow
 * @param {number} string
 * @param {number} place
 * @returns {[number, number]}
 */
function sliding(pitch, { shakes, string: asked, own }, isSlow, string, place) {
  const touched = own.touches
    ? NODES.findIndex(([on, above]) => OPEN[on] + above === pitch && [-1, on].includes(asked))
    : -1;
  if (touched >= 0) return [NODES[touched][0], placeOf(pitch, NODES[touched][0])];
  const [low, high] = own.reach.map((far) => pitch + far);
  if (low === high) return choose(pitch, asked, shakes && isSlow, own.beats, string, place);
  const isOpen = pitch < OPEN[0] + OPEN_WITHIN;
  if (low < OPEN[1] + OPEN_WITHIN && high <= HIGHEST[0] && asked !== 1)
    return [0, isOpen ? ON_OPEN : placeOf(pitch, 0)];
  if (low > OPEN[1] && asked !== 0) return [1, placeOf(pitch, 1)];
  return choose(pitch, asked, false, false, string, place);
}

/**
 * The string, and the finger's place on it as a share of its length, from where the finger was.
 * @param {number} pitch
 * @param {number} asked the string that is asked for
 * @param {boolean} shakes an open string is stopped on the other
 * @param {boolean} beats another finger, for which the inner string is too short
 * @param {number} string
 * @param {number} place
 * @returns {[number, number]}
 */
function choose(pitch, asked, shakes, beats, string, place) {
  const on = (/** @type {number} */ one) => placeOf(pitch, one);
  if (pitch < OPEN[0] + OPEN_WITHIN) return [0, ON_OPEN];
  if (asked === 0) return [0, on(0)];
  if (Math.abs(pitch - OPEN[1]) < OPEN_WITHIN && (asked === 1 || !shakes)) return [1, ON_OPEN];
  if (pitch < OPEN[1] + OPEN_WITHIN) return [0, on(0)];
  const isFar = asked === 1 || string !== 0 || place === ON_OPEN || beats || pitch > HIGHEST[0];
  const isNearer = !isFar && Math.abs(on(0) - place) < Math.abs(on(1) - place);
  return isNearer ? [0, on(0)] : [1, on(1)];
}

/**
 * A tune's notes, in order, within the instrument's range.
 * @param {Tune} tune
 * @returns {Note[]}
 */
export function notesOf(tune) {
  /** @type {Note[]} */
  const notes = [];
  /** @type {Map<string, Note>} */
  const open = new Map();
  for (const [at, [status, key, velocity]] of tune.events) {
    const kind = status & 0xf0;
    const channel = status & 0x0f;
    if (channel === PERCUSSION || (kind !== NOTE_ON && kind !== NOTE_OFF)) continue;
    const name = `${channel} ${key}`;
    const held = open.get(name);
    if (held) held.until = at;
    open.delete(name);
    if (kind !== NOTE_ON || velocity === 0) continue;
    const note = { at, until: tune.seconds, pitch: transposed(key), isTied: false };
    open.set(name, note);
    notes.push(note);
  }
  notes.forEach((note, i) => {
    const next = notes[i + 1];
    note.isTied = next !== undefined && note.until > next.at + OVERLAP && next.pitch !== note.pitch;
    if (next) note.until = Math.min(note.until, next.at);
  });
  return notes;
}
