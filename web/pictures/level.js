/** The level meter: how loud it is now, and at most of late. */

/** @typedef {import('./picture.js').Moment} Moment */

import { Picture } from "./picture.js";

const QUIETEST = -60; // dBFS, at the left
const LOUD = -3; // from here on the limiter works
const FALL = 24; // dB/s
const HOLD = 1.5; // s that the greatest level is marked

export class Level extends Picture {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    super(canvas);
    this.level = QUIETEST;
    this.most = QUIETEST;
    this.until = 0;
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Moment} moment
   */
  draw(context, { state, now, elapsed }) {
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
