/** Settings of the page, which the browser remembers. */

const KEY = "yehu";

/** The settings, and their values at first. */
const FIRST = {
  language: "", // '': the browser's
  theme: "", // '': the system's
  direction: "", // of the instrument; '': as there is room
  isAssisted: true,
  isLandingInTune: true,
  view: "slowed",
  panel: "", // '': none
  sound: "", // the preset that was chosen last; '': the first sound
  room: "",
  articulation: 0, // its number
  isTaught: false, // has seen, or skipped, the first gestures
  bestTone: 0, // s of full tone in the challenge
  isSlow: false, // tunes go at two thirds of their pace
  isBuffered: false, // later sound, but fewer drop-outs
  mapping: "", // '': the default one
  /** Binds that were learned, by the mapping that they lie over. @type {Record<string, unknown>} */
  learned: {},
  way: "", // of sounding, where there is a server; '': there where it has a device, else listening
};

/** @typedef {typeof FIRST} Values */

/** @returns {Values} */
function read() {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? "{}");
    /** @type {Record<string, unknown>} */
    const values = { ...FIRST };
    for (const [name, first] of Object.entries(FIRST)) {
      if (typeof kept[name] === typeof first && kept[name] !== null) values[name] = kept[name];
    }
    return /** @type {Values} */ (values);
  } catch {
    return { ...FIRST }; // nothing may be kept here, or it is no JSON
  }
}

export const settings = read();

/** Change some, and remember them. @param {Partial<Values>} changes */
export function remember(changes) {
  Object.assign(settings, changes);
  try {
    localStorage.setItem(KEY, JSON.stringify(settings));
  } catch {
    // Private windows keep nothing: the settings then last as long as the page.
  }
}
