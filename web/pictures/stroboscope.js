/** The motion of a string, from snapshots of its shape: from where it rests, and slowed. */

/** @typedef {import("../interfaces.js").Snapshot} Snapshot */

import { POINTS } from "../sound/snapshot.js";

const BINS = 64;
/** Longest that a bin is kept without news, in snapshots: a slow drift of the motion is followed. */
const OLDEST = 150;
/** How many bins the phase may be wrong at each shape, where the period is not known exactly. */
const SEARCH = 3;
const FOLLOW = 0.3; // of that error is corrected
/** Ratio of periods beyond which the note is another. */
const NEW_NOTE = 1.02;

/** Snapshots over which the place of rest is averaged: few until the string has settled, then more. */
const SETTLES = 12;
const FEWEST = 4;
const MOST = 40;
const MOVED = 1e-3; // m; a finger that moves farther changes the place of rest,
const PRESSED = 0.1; // and so does one that presses harder by so much, N

/** Slows a motion down: shapes are collected by their phase in the period. */
export class Stroboscope {
  constructor() {
    this.bins = Array.from({ length: BINS }, () => new Float32Array(POINTS));
    this.age = new Int32Array(BINS).fill(OLDEST);
    this.phase = 0;
    this.time = 0;
    this.period = 0;
    this.shape = new Float32Array(POINTS);
  }

  /** Forget the motion. */
  clear() {
    this.age.fill(OLDEST);
    this.phase = 0;
  }

  /**
   * Collect a shape.
   * @param {Float32Array} shape
   * @param {number} time s
   * @param {number} period s
   */
  add(shape, time, period) {
    const ratio = period / (this.period || period);
    if (!(period > 0) || ratio > NEW_NOTE || ratio < 1 / NEW_NOTE) this.clear();
    this.phase += (time - this.time) / (period || 1);
    this.phase -= Math.floor(this.phase);
    this.time = time;
    this.period = period;
    for (let i = 0; i < BINS; i++) this.age[i] = Math.min(this.age[i] + 1, OLDEST);
    this.#lock(shape);
    const bin = Math.floor(this.phase * BINS) % BINS;
    this.bins[bin].set(shape); // averages would round the corner
    this.age[bin] = 0;
  }

  /**
   * Correct the phase so that the shape is most like those that are kept.
   * @param {Float32Array} shape
   */
  #lock(shape) {
    let best = 0;
    let least = Infinity;
    for (let step = -SEARCH; step <= SEARCH; step++) {
      const bin = (Math.floor(this.phase * BINS) + step + BINS) % BINS;
      if (this.age[bin] >= OLDEST) continue;
      let error = 0;
      for (let i = 0; i < POINTS; i++) error += (shape[i] - this.bins[bin][i]) ** 2;
      if (error < least) [least, best] = [error, step];
    }
    this.phase += (FOLLOW * best) / BINS;
    this.phase -= Math.floor(this.phase);
  }

  /** @param {number} bin */
  isKnown(bin) {
    return this.age[bin] < OLDEST;
  }

  /** Whether anything is known of it. */
  get isSeen() {
    return this.age.some((age) => age < OLDEST);
  }

  /**
   * The shape at a phase, between those that are kept; valid until the next call.
   * @param {number} phase 0 to 1
   */
  at(phase) {
    const place = (phase - Math.floor(phase)) * BINS;
    let low = Math.floor(place);
    let high = low + 1;
    for (let i = 0; i < BINS && this.age[((low % BINS) + BINS) % BINS] >= OLDEST; i++) low--;
    for (let i = 0; i < BINS && this.age[high % BINS] >= OLDEST; i++) high++;
    const before = this.bins[((low % BINS) + BINS) % BINS];
    const after = this.bins[high % BINS];
    const part = Math.min((place - low) / Math.max(high - low, 1), 1);
    for (let i = 0; i < POINTS; i++) this.shape[i] = before[i] + part * (after[i] - before[i]);
    return this.shape;
  }
}

/**
 * Separates the motion of a string from where it rests: a finger that presses it, and the bow that
 * draws it aside, displace it by more than it swings.
 */
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
