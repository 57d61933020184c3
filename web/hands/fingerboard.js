/** The fingerboard: fingers of the left hand on it, by touch, pen, mouse or arrow keys. */

/** @typedef {import('./hands.js').Hands} Hands */
/** @typedef {import('./pointers.js').Touch} Touch */

import { Pointers } from "./pointers.js";
import { HIGHEST, Landing, LOWEST, Scale, nameOf, withinRange } from "./scale.js";

const VELOCITY = 0.63; // of a keyboard's 80
/** Fingers press as usual in the middle of the board; at its sides these times as hard. */
const LIGHTEST = 0.4;
const HARDEST = 3;
const MIDDLE = 0.25; // half the middle's share of the board
const ARROWS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
const FINE = 0.1; // semitones, with the shift key
const BY_KEYS = "arrows";

export class Fingerboard extends EventTarget {
  /**
   * @param {HTMLCanvasElement} element
   * @param {Hands} hands
   * @param {import('./key_tuning.js').KeyTuning} tuned
   */
  constructor(element, hands, tuned) {
    super();
    this.tuned = tuned;
    this.element = element;
    this.hands = hands;
    /** @type {'across' | 'down'} which way pitches rise: to the right, or downwards */
    this.direction = "across";
    this.isLandingInTune = true;
    this.lowest = LOWEST;
    this.scale = new Scale(1);
    /** @type {Map<number, Landing>} */
    this.landings = new Map();
    this.place = 69; // where the arrow keys stop the string
    /** @type {number | null} a pitch that should be shown */
    this.wanted = null;
    hands.addEventListener("change", () => this.bring(this.wanted));
    this.pointers = new Pointers(element, {
      down: (touch) => this.#down(touch),
      move: (touches) => this.#move(touches),
      up: (id) => this.#up(id),
    });
    new ResizeObserver(() => this.measure()).observe(element);
    element.addEventListener("keydown", (event) => this.#press(event));
    element.addEventListener("keyup", (event) => {
      if (event.key === " " || event.key === "Enter") hands.lift(BY_KEYS);
    });
    element.addEventListener("blur", () => hands.lift(BY_KEYS));
    this.measure();
  }

  /** Fit the scale to the element's size. */
  measure() {
    const { clientWidth, clientHeight } = this.element;
    this.scale = new Scale(this.direction === "across" ? clientWidth : clientHeight, this.lowest);
    this.lowest = this.scale.first;
    this.#tell();
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

  /** @param {'across' | 'down'} direction */
  turn(direction) {
    this.pointers.endAll();
    this.direction = direction;
    this.measure();
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
    const { first, span } = this.scale;
    if (pitch === null || this.hands.fingers.length || (pitch >= first && pitch <= first + span)) {
      return;
    }
    this.lowest = pitch < first ? pitch : pitch - span;
    this.measure();
  }

  /** @param {Touch} touch */
  #down(touch) {
    const place = this.#placeOf(touch);
    const landing = new Landing(place, this.tuned.nearest(withinRange(place)));
    this.landings.set(touch.id, landing);
    this.dispatchEvent(new Event("play"));
    this.hands.touch(
      touch.id,
      this.isLandingInTune ? landing.pitchAt(landing.place) : place,
      touch.pressure === null ? VELOCITY : 0.3 + 0.7 * touch.pressure,
    );
    this.hands.lean(touch.id, this.#pressOf(touch));
  }

  /** @param {Touch[]} touches */
  #move(touches) {
    // A finger is where it is last: a wish for each point of its way says no more.
    const touch = touches[touches.length - 1];
    const place = this.#placeOf(touch);
    const landing = this.landings.get(touch.id);
    this.hands.slide(touch.id, landing && this.isLandingInTune ? landing.pitchAt(place) : place);
    this.hands.lean(touch.id, this.#pressOf(touch));
  }

  /** @param {number} id */
  #up(id) {
    this.landings.delete(id);
    this.hands.lift(id);
  }

  /** @param {Touch} touch */
  #placeOf({ x, y }) {
    return this.scale.pitchAt(this.direction === "across" ? x : y);
  }

  /**
   * The factor on the usual press: by pressure, or by the place beside the string.
   * @param {Touch} touch
   */
  #pressOf({ x, y, pressure }) {
    const { clientWidth, clientHeight } = this.element;
    const across = this.direction === "across" ? 0.5 - y / clientHeight : x / clientWidth - 0.5;
    const away = pressure === null ? across : pressure - 0.5;
    const beyond = (Math.min(Math.abs(away), 0.5) - MIDDLE) / (0.5 - MIDDLE);
    if (beyond <= 0) return 1;
    return (away > 0 ? HARDEST : LIGHTEST) ** beyond;
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = ARROWS[/** @type {keyof typeof ARROWS} */ (event.key)];
    if (step) {
      const size = event.shiftKey ? FINE : 1;
      this.place = Math.min(Math.max(this.place + step * size, LOWEST), HIGHEST);
      this.hands.slide(BY_KEYS, this.place);
      this.#tell();
    } else if ((event.key === " " || event.key === "Enter") && !event.repeat) {
      this.dispatchEvent(new Event("play"));
      this.hands.touch(BY_KEYS, this.place, VELOCITY);
    } else if (event.key !== " " && event.key !== "Enter") {
      return;
    }
    event.preventDefault();
  }

  /** Tell screen readers where the finger is. */
  #tell() {
    this.element.setAttribute("aria-valuemin", String(LOWEST));
    this.element.setAttribute("aria-valuemax", String(HIGHEST));
    this.element.setAttribute("aria-valuenow", this.place.toFixed(1));
    const cents = Math.round((this.place - Math.round(this.place)) * 100);
    const beside = cents ? ` ${cents > 0 ? "+" : "−"}${Math.abs(cents)}` : "";
    this.element.setAttribute("aria-valuetext", nameOf(this.place) + beside);
    this.element.setAttribute(
      "aria-orientation",
      this.direction === "across" ? "horizontal" : "vertical",
    );
  }
}
