/** Turns touches of fingers and bow into calls of the player. */

/** @typedef {import('../interfaces.js').Player} Player */
/** @typedef {import('../interfaces.js').NoteId} NoteId */

import { OPEN, withinRange } from "./scale.js";

const DYNAMICS = "/playing/dynamics";
const VIBRATO = "/playing/vibrato";
/** Least change of the dynamics that is worth a command, as a share of them. */
const STEP = 0.02;
/** After so long without a finger, ms, others play as loud as before: a note has died away. */
const RETURNS_AFTER = 600;

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
 * one before. Events: 'play' before a hand does something, 'change' after it, 'rock'.
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
    /** Parameters that fingers move, and their values before. @type {Map<string, number>} */
    this.usual = new Map();
    this.dynamics = 1; // as a share of the usual ones
    this.returning = 0; // timer
    this.stroke = { speed: 0, force: 0 };
  }

  /** Somebody plays from now on. */
  begin() {
    this.dispatchEvent(new Event("play"));
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
   * @param {number} dynamics as a share of the usual ones
   */
  touch(id, pitch, velocity, dynamics = 1) {
    this.lift(id);
    this.#swell(dynamics);
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
   * The note of the top finger becomes louder or softer.
   * @param {NoteId} id
   * @param {number} dynamics as a share of the usual ones
   */
  swell(id, dynamics) {
    if (this.top?.id === id) this.#swell(dynamics);
  }

  /** @param {number} dynamics */
  #swell(dynamics) {
    clearTimeout(this.returning);
    if (Math.abs(dynamics / this.dynamics - 1) < STEP) return;
    this.dynamics = dynamics;
    this.#move(DYNAMICS, dynamics);
  }

  /** The finger rocks by itself: the player's own vibrato rests until it goes. */
  rock() {
    if (!this.usual.has(VIBRATO)) this.#move(VIBRATO, 0);
    this.dispatchEvent(new Event("rock"));
  }

  /** @param {string} address @param {number} factor on its usual value */
  #move(address, factor) {
    const usual = this.usual.get(address) ?? this.player.value(address);
    this.usual.set(address, usual);
    this.player.write(address, usual * factor);
  }

  /** What fingers moved is as it was before. */
  #return() {
    for (const [address, value] of this.usual) this.player.write(address, value);
    this.usual.clear();
    this.dynamics = 1;
  }

  /** A finger goes. @param {NoteId} id */
  lift(id) {
    const at = this.fingers.findIndex((one) => one.id === id);
    if (at < 0) return;
    const [finger] = this.fingers.splice(at, 1);
    if (finger.isNote) this.player.noteOff(id);
    if (at === this.fingers.length) this.#stopBelow(finger);
    if (this.fingers.length === 0) {
      clearTimeout(this.returning);
      this.returning = window.setTimeout(() => this.#return(), RETURNS_AFTER);
    }
    this.#changed();
  }

  /** The string is stopped by the finger before, or open. @param {HeldFinger} last */
  #stopBelow(last) {
    const top = this.top;
    if (!top) {
      // The player lifts the finger of a note that ends; a finger that only stopped is lifted here.
      if (!last.isNote) this.player.slide(openBelow(last.pitch));
    } else if (!top.isNote || !last.isNote || top.pitch !== top.begun) {
      this.player.slide(top.pitch);
    }
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

/** The open string that sounds when a finger is lifted. @param {number} pitch */
function openBelow(pitch) {
  return pitch > OPEN[1] ? OPEN[1] : OPEN[0];
}
