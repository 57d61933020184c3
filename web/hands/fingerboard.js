/** The fingerboard: fingers of the left hand on it, by touch, pen, mouse or arrow keys. */

/** @typedef {import('./hands.js').Hands} Hands */
/** @typedef {import('./pointers.js').Touch} Touch */

import { Pointers } from "./pointers.js";
import { HIGHEST, Landing, LOWEST, Scale, nameOf, withinRange } from "./scale.js";

const VELOCITY = 0.63; // of a keyboard's 80
/** The softest note, as a share of the usual dynamics; the loudest is the usual one. */
const SOFTEST = 0.25;
const EDGE = 0.06; // of the breadth, in which it is as soft or loud as can be
const BEND = 1.5; // middle notes are nearer to the loud ones
const ARROWS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
const FINE = 0.1; // semitones, with the shift key
const BY_KEYS = "arrows";

// Of a finger that rocks:
const LEAST = 0.03; // semitones from one turn to the next; less is a hand at rest
const MOST = 1.2; // and more is a slide
const SOONEST = 40; // ms from turn to turn
const LATEST = 350;
const TURNS = 3;

export class Fingerboard extends EventTarget {
  /**
   * @param {HTMLElement} element
   * @param {Hands} hands
   * @param {import('./scale.js').KeyTuning} tuned
   * @param {import('./surface.js').Surface} surface
   */
  constructor(element, hands, tuned, surface) {
    super();
    this.tuned = tuned;
    this.element = element;
    this.hands = hands;
    this.surface = surface;
    this.isLandingInTune = true;
    this.lowest = LOWEST;
    this.scale = new Scale(1);
    /** Fingers that are down. @type {Map<number, {landing: Landing, rocking: Rocking, loud: number}>} */
    this.touches = new Map();
    this.place = 69; // where the arrow keys stop the string
    /** @type {number | null} a pitch that should be shown */
    this.wanted = null;
    hands.addEventListener("change", () => this.bring(this.wanted));
    this.pointers = new Pointers(element, {
      down: (touch) => this.#down(touch),
      move: (touches) => this.#move(touches),
      up: (id, kind) => this.#up(id, kind),
    });
    surface.addEventListener("change", () => this.measure());
    element.addEventListener("keydown", (event) => this.#press(event));
    element.addEventListener("keyup", (event) => {
      if (event.key === " " || event.key === "Enter") hands.lift(BY_KEYS);
    });
    element.addEventListener("blur", () => hands.lift(BY_KEYS));
    this.measure();
  }

  /** Fit the scale to the element's size. */
  measure() {
    const { board } = this.surface;
    this.scale = new Scale(board[1] - board[0], this.lowest);
    this.lowest = this.scale.first;
    this.#announce();
    this.dispatchEvent(new Event("change"));
  }

  /** Whether the lowest note is shown. */
  get isLowest() {
    return this.scale.first <= LOWEST;
  }

  /** Whether the highest note is shown. */
  get isHighest() {
    return this.scale.first + this.scale.span >= HIGHEST;
  }

  /** @param {number} semitones */
  shift(semitones) {
    this.pointers.endAll();
    this.lowest += semitones;
    this.measure();
  }

  /**
   * Show the part of the board that has a pitch, once no finger is on it.
   * @param {number | null} pitch null: whatever is shown is right
   */
  bring(pitch) {
    this.wanted = pitch;
    if (pitch !== null) this.show(pitch);
  }

  /** @param {number} pitch shown now, if no finger is on the board */
  show(pitch) {
    const { first, span } = this.scale;
    if (this.hands.fingers.length || (pitch >= first && pitch <= first + span)) return;
    this.lowest = pitch < first ? pitch : pitch - span;
    this.measure();
  }

  /** @param {Touch} touch */
  #down(touch) {
    const place = this.#placeOf(touch);
    const landing = new Landing(place, this.tuned.nearest(withinRange(place)));
    const loud = this.#loudnessOf(touch);
    this.touches.set(touch.id, { landing, rocking: new Rocking(), loud });
    this.hands.begin();
    const pitch = this.isLandingInTune ? landing.pitchAt(place) : place;
    this.hands.touch(touch.id, pitch, VELOCITY, dynamicsOf(loud));
  }

  /** @param {Touch[]} touches */
  #move(touches) {
    // A finger is where it is last: a request for each point of its way says no more.
    const touch = touches[touches.length - 1];
    const held = this.touches.get(touch.id);
    if (!held) return;
    const place = this.#placeOf(touch);
    held.loud = this.#loudnessOf(touch);
    this.hands.slide(touch.id, this.isLandingInTune ? held.landing.pitchAt(place) : place);
    this.hands.swell(touch.id, dynamicsOf(held.loud));
    if (held.rocking.isOn(place, touch.time)) this.hands.rock();
  }

  /** @param {number} id @param {string} kind of its pointer */
  #up(id, kind) {
    this.touches.delete(id);
    // A mouse cannot hold a finger and draw the bow: what it has stopped stays so.
    if (kind !== "mouse" || this.hands.isAssisted) this.hands.lift(id);
  }

  /** @param {Touch} touch */
  #placeOf({ x, y }) {
    return this.scale.pitchAt(this.surface.isUpright ? y : x);
  }

  /**
   * How loud a touch asks to be: by its pressure, or by its place across the strings; 0 to 1.
   * @param {Touch} touch
   */
  #loudnessOf({ x, y, pressure }) {
    const { clientWidth, clientHeight } = this.element;
    const share = pressure ?? (this.surface.isUpright ? x / clientWidth : 1 - y / clientHeight);
    return Math.min(Math.max((share - EDGE) / (1 - 2 * EDGE), 0), 1);
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = ARROWS[/** @type {keyof typeof ARROWS} */ (event.key)];
    if (step) {
      const size = event.shiftKey ? FINE : 1;
      this.place = Math.min(Math.max(this.place + step * size, LOWEST), HIGHEST);
      this.hands.slide(BY_KEYS, this.place);
      this.#announce();
    } else if ((event.key === " " || event.key === "Enter") && !event.repeat) {
      this.hands.begin();
      this.hands.touch(BY_KEYS, this.place, VELOCITY);
    } else if (event.key !== " " && event.key !== "Enter") {
      return;
    }
    event.preventDefault();
  }

  /** Announce to screen readers where the finger is. */
  #announce() {
    this.element.setAttribute("aria-valuemin", String(LOWEST));
    this.element.setAttribute("aria-valuemax", String(HIGHEST));
    this.element.setAttribute("aria-valuenow", this.place.toFixed(1));
    const cents = Math.round((this.place - Math.round(this.place)) * 100);
    const beside = cents ? ` ${cents > 0 ? "+" : "−"}${Math.abs(cents)}` : "";
    this.element.setAttribute("aria-valuetext", nameOf(this.place) + beside);
    this.element.setAttribute(
      "aria-orientation",
      this.surface.isUpright ? "vertical" : "horizontal",
    );
  }
}

/** The dynamics of a loudness, as a share of the usual ones. @param {number} loud 0 to 1 */
function dynamicsOf(loud) {
  return SOFTEST ** ((1 - loud) ** BEND);
}

/** Notices a finger that rocks to and fro, as in a vibrato. */
class Rocking {
  constructor() {
    this.turns = 0;
    this.way = 0; // the direction in which it moves
    this.farthest = NaN; // where it came to on its way, and where it had turned
    this.turned = NaN;
    this.time = 0;
  }

  /**
   * Whether a finger rocks, being at a pitch.
   * @param {number} pitch
   * @param {number} time ms
   */
  isOn(pitch, time) {
    if (Number.isNaN(this.turned)) {
      [this.turned, this.farthest, this.time] = [pitch, pitch, time];
    }
    if ((pitch - this.farthest) * this.way >= 0 && this.way !== 0) this.farthest = pitch;
    else if (Math.abs(pitch - this.farthest) >= LEAST) {
      const size = Math.abs(this.farthest - this.turned);
      const lasted = time - this.time;
      const isTurn = this.way !== 0 && size <= MOST && lasted >= SOONEST && lasted <= LATEST;
      this.turns = isTurn ? this.turns + 1 : 0;
      [this.turned, this.time, this.way] = [this.farthest, time, Math.sign(pitch - this.farthest)];
      this.farthest = pitch;
    }
    return this.turns >= TURNS;
  }
}
