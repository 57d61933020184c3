/** The tuner, and the level meter below it. */

/** @typedef {import('./picture.js').Moment} Moment */

import { nameOf } from "../hands/scale.js";
import { Picture, font } from "./picture.js";
import { SteadyPitch, soundingPitch } from "../sound/snapshot.js";

const RANGE = 50; // cents to either side
const TRUE_WITHIN = 5;
const LASTS = 4; // s of the trace
const SMOOTH = 0.08; // s

const QUIETEST = -60; // dBFS, at the left
const LOUD = -3; // from here on the limiter works
const FALL = 24; // dB/s
const HOLD = 1.5; // s that the greatest level is marked

/** The note of the tuning that sounds, and how far from it, in cents: its mean, now, and over the last seconds. */
export class Tuner extends Picture {
  /** @param {HTMLCanvasElement} canvas @param {import('../hands/scale.js').KeyTuning} tuned */
  constructor(canvas, tuned) {
    super(canvas);
    this.tuned = tuned;
    /** @type {{time: number, pitch: number}[]} */
    this.trace = [];
    this.pitch = NaN;
    this.steady = new SteadyPitch();
  }

  /** @param {Moment} moment */
  draw({ state, isNew, now, elapsed }) {
    const { context } = this;
    if (state && isNew) this.#hear(soundingPitch(state), now, elapsed);
    const { width, height } = this;
    const note = this.tuned.nearest(this.steady.pitch);
    const sounds = !Number.isNaN(this.pitch);
    const cents = (this.steady.pitch - note) * 100;
    const isTrue = Math.abs(cents) <= TRUE_WITHIN;
    context.textBaseline = "middle";
    context.textAlign = "left";
    context.fillStyle = sounds ? this.colours.ink : this.colours.faint;
    context.font = font(Math.min(height * 0.42, this.left * 0.45), 600);
    context.fillText(sounds ? nameOf(note) : "–", 2, height * 0.4);
    if (sounds) {
      context.font = font(13);
      context.fillStyle = isTrue ? this.colours.good : this.colours.soft;
      const whole = Math.round(cents);
      const sign = whole < 0 ? "−" : whole > 0 ? "+" : "";
      context.fillText(`${sign}${Math.abs(whole)} ct`, 4, height * 0.8);
    }
    this.#frame();
    this.#trace(note, now);
    if (!sounds) return;
    context.fillStyle = isTrue ? this.colours.good : this.colours.bad;
    context.beginPath(); // the needle
    context.roundRect(this.#across((this.pitch - note) * 100) - 2.5, this.bottom - 26, 5, 26, 2.5);
    context.fill();
  }

  /**
   * @param {number} pitch
   * @param {number} now s
   * @param {number} elapsed s
   */
  #hear(pitch, now, elapsed) {
    this.steady.take(pitch, now);
    const share = Math.min(elapsed / SMOOTH, 1);
    const isNear = Math.abs(pitch - this.pitch) < 0.5;
    this.pitch = isNear ? this.pitch + share * (pitch - this.pitch) : pitch;
    this.trace.push({ time: now, pitch: this.pitch });
    while (this.trace.length && this.trace[0].time < now - LASTS) this.trace.shift();
  }

  /** Where the scale begins. */
  get left() {
    return Math.min(120, this.width * 0.3);
  }

  get bottom() {
    return this.height - 20;
  }

  /** @param {number} cents */
  #across(cents) {
    return this.left + ((cents + RANGE) / (2 * RANGE)) * (this.width - this.left - 8);
  }

  #frame() {
    const { context, colours, bottom } = this;
    context.font = font(11);
    context.textAlign = "center";
    context.textBaseline = "top";
    for (let cents = -RANGE; cents <= RANGE; cents += 10) {
      const size = cents === 0 ? bottom - 6 : Math.abs(cents) === RANGE ? 10 : 6;
      context.fillStyle = cents === 0 ? colours.soft : colours.line;
      context.fillRect(this.#across(cents) - 0.5, bottom - size, 1, size);
    }
    context.fillStyle = colours.soft;
    for (const [cents, text, inset] of /** @type {const} */ ([
      [-RANGE, "−50", 8],
      [0, "0", 0],
      [RANGE, "+50", -8],
    ])) {
      context.fillText(text, this.#across(cents) + inset, bottom + 5);
    }
  }

  /**
   * The pitch over time: the latest at the bottom, as the needle leaves it behind.
   * @param {number} note its pitch
   * @param {number} now
   */
  #trace(note, now) {
    const { context, left, bottom } = this;
    context.save();
    context.beginPath();
    context.rect(left, 0, this.width - left, bottom);
    context.clip();
    context.strokeStyle = this.colours.faint;
    context.lineWidth = 1.5;
    context.beginPath();
    let last = NaN;
    for (const { time, pitch } of this.trace) {
      const x = this.#across((pitch - note) * 100);
      const y = bottom - ((now - time) / LASTS) * bottom;
      // Another note, or one after silence, begins another line.
      if (Math.abs(pitch - last) < 0.5) context.lineTo(x, y);
      else if (!Number.isNaN(pitch)) context.moveTo(x, y);
      last = pitch;
    }
    context.stroke();
    context.restore();
  }
}

/** How loud it is now, and at most of late. */
export class Level extends Picture {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    super(canvas);
    this.level = QUIETEST;
    this.most = QUIETEST;
    this.until = 0;
  }

  /** @param {Moment} moment */
  draw({ state, now, elapsed }) {
    const { context } = this;
    const heard = Math.max(state?.level ?? QUIETEST, QUIETEST); // NaN never comes: silence is -inf
    this.level = Math.max(heard, this.level - FALL * elapsed);
    if (this.level >= this.most || now > this.until) {
      this.most = this.level;
      this.until = now + HOLD;
    }
    const { width, height } = this;
    const place = (/** @type {number} */ level) => (Math.min(level, 0) / -QUIETEST + 1) * width;
    context.fillStyle = this.colours.line;
    context.beginPath();
    context.roundRect(0, 0, width, height, height / 2);
    context.fill();
    context.save();
    context.clip();
    context.fillStyle = this.level > LOUD ? this.colours.bad : this.colours.soft;
    context.fillRect(0, 0, place(this.level), height);
    context.fillStyle = this.colours.ink;
    if (this.most > QUIETEST) context.fillRect(place(this.most) - 2, 0, 2, height);
    context.restore();
  }
}
