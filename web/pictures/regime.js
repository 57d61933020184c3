/** Names the string's motion, from what the ear hears. */

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */

/** From here on a motion repeats itself well enough to be a tone. */
const CERTAIN = 0.8;
const FAINT = -70; // dBFS; below is silence
const TWICE = 1.5; // slips in a period; from here on the string slips too often

/**
 * The regime of the string.
 * @param {Snapshot} state
 * @returns {'silent' | 'ringing' | 'unheard' | 'helmholtz' | 'slipping' | 'raucous' | 'settling'}
 */
export function regimeOf({ bow, heard, level, schelleng }) {
  if (bow.string < 0 || bow.speed === 0) return level > FAINT ? "ringing" : "silent";
  if (heard.certainty === 0) return "unheard";
  if (heard.certainty >= CERTAIN) return heard.slips < TWICE ? "helmholtz" : "slipping";
  if (Math.abs(bow.force) > schelleng.max) return "raucous";
  return heard.slips >= TWICE ? "slipping" : "settling";
}

/**
 * The pitch that sounds, as far as it is heard: a fractional MIDI note, or NaN.
 * @param {Snapshot} state
 */
export function soundingPitch({ pitch, heard }) {
  return pitch + (heard.certainty >= CERTAIN ? heard.errorCents / 100 : 0);
}
