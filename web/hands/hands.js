/** Makes of fingers and bow strokes what the player is asked for. */

/** @typedef {import('../interfaces.js').Player} Player */
/** @typedef {import('../interfaces.js').NoteId} NoteId */

import { OPEN, withinRange } from "./scale.js";

const PRESS = "/playing/press";
/** Least change of the press that is worth a wish, as a share of it. */
const PRESS_STEP = 0.02;

/**
 * @typedef {object} HeldFinger
 * @property {NoteId} id
 * @property {number} pitch where it is
 * @property {number} begun pitch that its note began with
 * @property {boolean} isNote the instrument bows it
 */

/**
 * Both hands. With assist a finger is a note, which the player bows; without, and while the bow is
 * drawn by hand, fingers only stop the string. The last finger sounds; lifting it returns to the
 * one before.
 */
export class Hands extends EventTarget {
  /** @param {Player} player */
  constructor(player) {
    super();
    this.player = player;
    this.isAssisted = true;
    this.isBowing = false;
    /** @type {HeldFinger[]} in the order in which they came */
    this.fingers = [];
    /** @type {number | null} press before fingers changed it */
    this.usualPress = null;
    this.press = 1;
    this.stroke = { speed: 0, force: 0 };
  }

  /** The finger that stops the string. */
  get top() {
    return this.fingers.at(-1);
  }

  /**
   * A finger comes.
   * @param {NoteId} id
   * @param {number} pitch fractional MIDI note
   * @param {number} velocity 0 to 1
   */
  touch(id, pitch, velocity) {
    this.lift(id);
    const isNote = this.isAssisted && !this.isBowing;
    const stopped = withinRange(pitch);
    this.fingers.push({ id, pitch: stopped, begun: stopped, isNote });
    if (isNote) this.player.fingerOn(id, stopped, velocity);
    else this.player.slide(stopped);
    this.#changed();
  }

  /**
   * A finger slides.
   * @param {NoteId} id
   * @param {number} pitch
   */
  slide(id, pitch) {
    const finger = this.fingers.find((one) => one.id === id);
    const stopped = withinRange(pitch);
    if (!finger || finger.pitch === stopped) return;
    finger.pitch = stopped;
    if (finger === this.top) this.player.slide(stopped);
    this.#changed();
  }

  /**
   * The top finger presses harder or lighter.
   * @param {NoteId} id
   * @param {number} factor on the usual press
   */
  lean(id, factor) {
    if (this.top?.id !== id || Math.abs(factor / this.press - 1) < PRESS_STEP) return;
    this.usualPress ??= this.player.value(PRESS);
    this.press = factor;
    this.player.write(PRESS, this.usualPress * factor);
  }

  /**
   * A finger goes.
   * @param {NoteId} id
   */
  lift(id) {
    const at = this.fingers.findIndex((one) => one.id === id);
    if (at < 0) return;
    const [finger] = this.fingers.splice(at, 1);
    if (finger.isNote) this.player.noteOff(id);
    if (at === this.fingers.length) this.#return(finger);
    if (this.fingers.length === 0) this.#restPress();
    this.#changed();
  }

  /**
   * The string is stopped by the finger before, or open.
   * @param {HeldFinger} last
   */
  #return(last) {
    const top = this.top;
    if (!top) {
      // The player lifts the finger of a note that ends; a finger that only stopped is lifted here.
      if (!last.isNote) this.player.slide(openBelow(last.pitch));
    } else if (!top.isNote || !last.isNote || top.pitch !== top.begun) {
      this.player.slide(top.pitch);
    }
  }

  #restPress() {
    if (this.usualPress !== null) this.player.write(PRESS, this.usualPress);
    this.usualPress = null;
    this.press = 1;
  }

  /**
   * The bow moves on the string.
   * @param {number} speed m/s
   * @param {number} force N
   */
  draw(speed, force) {
    if (this.isBowing && this.stroke.speed === speed && this.stroke.force === force) return;
    this.isBowing = true;
    this.stroke = { speed, force };
    this.player.draw(speed, force);
    this.#changed();
  }

  /** The bow leaves the string. */
  liftBow() {
    if (!this.isBowing) return;
    this.isBowing = false;
    this.stroke = { speed: 0, force: 0 };
    this.player.lift();
    this.#changed();
  }

  /** Both hands leave the instrument. */
  rest() {
    for (const { id } of [...this.fingers].reverse()) this.lift(id);
    this.liftBow();
  }

  #changed() {
    this.dispatchEvent(new Event("change"));
  }
}

/**
 * The open string that sounds when a finger is lifted.
 * @param {number} pitch
 */
function openBelow(pitch) {
  return pitch > OPEN[1] ? OPEN[1] : OPEN[0];
}
