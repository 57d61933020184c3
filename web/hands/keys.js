/** The computer's keyboard as a piano of two rows: F4 to F5, and F5 to F6. */

/** @typedef {import('./hands.js').Hands} Hands */

import { onLeave } from "./pointers.js";
import { HIGHEST, LOWEST } from "./scale.js";

/** Keys by their places, so that any national layout is the same piano. */
const LOWER =
  "KeyZ KeyS KeyX KeyD KeyC KeyF KeyV KeyB KeyH KeyN KeyJ KeyM Comma KeyL Period Semicolon Slash".split(
    " ",
  );
const UPPER = "KeyQ Digit2 KeyW Digit3 KeyE Digit4 KeyR KeyT Digit6 KeyY Digit7 KeyU KeyI".split(
  " ",
);
const FIRST_LOWER = 65;
const FIRST_UPPER = 77;
const OCTAVE = { Minus: -12, Equal: 12 };
const VELOCITY = 0.63;
const SILENCE = "Escape";
const LEAVING = ["Enter", "Escape"]; // end what is typed in a field

/** Notes of the keys, without the octave keys. */
export const NOTES = new Map([
  ...LOWER.map((code, step) => /** @type {[string, number]} */ ([code, FIRST_LOWER + step])),
  ...UPPER.map((code, step) => /** @type {[string, number]} */ ([code, FIRST_UPPER + step])),
]);

const SIGNS = { Comma: ",", Period: ".", Slash: "/", Semicolon: ";" };

/** What is written on a key. @param {string} code */
export function signOf(code) {
  return SIGNS[/** @type {keyof typeof SIGNS} */ (code)] ?? code.replace(/Key|Digit/, "");
}

/** Elements that take letters themselves. A list that is open finds by letters what it offers. */
const TYPED = "input:not([type=range], [type=checkbox], [type=radio], [readonly]), textarea";
const OPEN_LIST = CSS.supports("selector(:open)") ? "select:open" : "select:active";

/** Text is being typed. @param {EventTarget | null} target */
export function isWriting(target) {
  return target instanceof Element && target.matches(`${TYPED}, ${OPEN_LIST}`);
}

export class Keys extends EventTarget {
  /** @param {Hands} hands @param {import('./scale.js').KeyTuning} tuned */
  constructor(hands, tuned) {
    super();
    this.tuned = tuned;
    this.hands = hands;
    this.octave = 0;
    /** @type {Set<string>} */
    this.down = new Set();
    window.addEventListener("keydown", (event) => this.#press(event));
    window.addEventListener("keyup", (event) => this.#release(event.code));
    onLeave(() => this.releaseAll());
    // A field that takes letters also takes the keyup.
    document.addEventListener("focusin", (event) => {
      if (isWriting(event.target)) this.releaseAll();
    });
  }

  /** Lift all keys. */
  releaseAll() {
    for (const code of [...this.down]) this.#release(code);
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    const focused = document.activeElement;
    if (focused instanceof HTMLElement) delete focused.dataset.touched; // keys that find the way show where
    if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return;
    if (event.key === "?") return; // asks for help
    if (isWriting(event.target)) {
      // What was typed is done: from now on keys play again.
      if (event.target instanceof HTMLInputElement && LEAVING.includes(event.key))
        event.target.blur();
      return;
    }
    if (event.code in OCTAVE) {
      this.#shift(OCTAVE[/** @type {keyof typeof OCTAVE} */ (event.code)]);
      return;
    }
    if (event.code === SILENCE) this.dispatchEvent(new Event("silence"));
    const note = NOTES.get(event.code);
    if (note === undefined) return;
    event.preventDefault(); // "/" and "'" would open the browser's search
    if (focused instanceof HTMLElement) focused.dataset.touched = ""; // those that play need no ring
    if (event.repeat || this.down.has(event.code)) return;
    const pitch = this.tuned.pitchOf(note + this.octave);
    if (pitch === null || Math.round(pitch) < LOWEST || Math.round(pitch) > HIGHEST) return;
    this.down.add(event.code);
    this.dispatchEvent(new Event("play"));
    this.hands.begin();
    this.hands.touch(event.code, pitch, VELOCITY);
  }

  /** @param {string} code */
  #release(code) {
    if (this.down.delete(code)) this.hands.lift(code);
  }

  /** @param {number} semitones */
  #shift(semitones) {
    this.octave = Math.min(Math.max(this.octave + semitones, -12), 12);
    this.dispatchEvent(new Event("octave"));
  }
}
