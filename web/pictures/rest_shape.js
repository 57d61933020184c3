/**
 * Tells the motion of a string from where it rests: a finger that presses it, and the bow that
 * draws it aside, displace it by more than it swings.
 */

const POINTS = 64;
/** Snapshots over which the place of rest is averaged: few until the string has settled, then more. */
const SETTLES = 12;
const FEWEST = 4;
const MOST = 40;
const MOVED = 1e-3; // m; a finger that moves farther changes the place of rest,
const PRESSED = 0.1; // and so does one that presses harder by so much, N

/** @typedef {import("../interfaces.js").Snapshot} Snapshot */

export class RestShape {
  constructor() {
    this.mean = new Float32Array(POINTS);
    this.count = 0;
    this.stop = 0;
    this.press = 0;
    this.string = -1;
  }

  /** Whether the string has just come to another place. */
  get isNew() {
    return this.count === 1;
  }

  /** Whether it has been there for long enough that its motion is known. */
  get isSettled() {
    return this.count > SETTLES;
  }

  /**
   * The displacement of a string from its place of rest (m).
   * @param {Float32Array} shape
   * @param {Snapshot} state
   */
  without(shape, { fingers, bow }) {
    const stop = fingers.reduce((farthest, { x }) => Math.max(farthest, x), 0);
    const press = fingers.reduce((sum, finger) => sum + finger.press, 0);
    const isMoved = Math.abs(stop - this.stop) > MOVED || Math.abs(press - this.press) > PRESSED;
    if (isMoved || bow.string !== this.string) this.count = 0;
    this.stop = stop;
    this.press = press;
    this.string = bow.string;
    this.count++;
    const over = Math.min(Math.max(this.count - SETTLES, FEWEST), MOST);
    const share = this.isNew ? 1 : 1 / over;
    const motion = new Float32Array(POINTS);
    for (let i = 0; i < POINTS; i++) {
      this.mean[i] += share * (shape[i] - this.mean[i]);
      motion[i] = shape[i] - this.mean[i];
    }
    return motion;
  }
}
