/** What is heard of a voice that is followed, over what is played: their pitches in the last seconds. */

/** @typedef {import('./picture.js').Moment} Moment */

import { nameOf } from "../hands/scale.js";
import { Picture, font } from "./picture.js";
import { soundingPitch } from "../sound/snapshot.js";

const LASTS = 6; // s
const LEAST = 5; // semitones that are shown
const OCTAVE = 12;

export class Voice extends Picture {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {() => number} heard pitch of the voice; NaN for none
   */
  constructor(canvas, heard) {
    super(canvas);
    this.heard = heard;
    /** @type {{time: number, heard: number, played: number}[]} */
    this.trace = [];
    this.octaves = 0; // by which it is played higher
  }

  /** @param {Moment} moment */
  draw({ state, isNew, now }) {
    const { context } = this;
    if (state && isNew) {
      const [heard, played] = [this.heard(), soundingPitch(state)];
      const away = Math.round((played - heard) / OCTAVE);
      if (!Number.isNaN(away)) this.octaves = away; // else as it was played last
      this.trace.push({ time: now, heard: heard + OCTAVE * this.octaves, played });
    }
    while (this.trace.length && this.trace[0].time < now - LASTS) this.trace.shift();
    const pitches = this.trace.flatMap(({ heard, played }) => [heard, played]);
    const there = pitches.filter((pitch) => !Number.isNaN(pitch));
    if (!there.length) return;
    const middle = (Math.min(...there) + Math.max(...there)) / 2;
    const span = Math.max(Math.max(...there) - Math.min(...there) + 2, LEAST);
    const y = (/** @type {number} */ pitch) => (0.5 - (pitch - middle) / span) * this.height;
    const x = (/** @type {number} */ time) => (1 - (now - time) / LASTS) * this.width;
    context.font = font(11);
    context.textBaseline = "bottom";
    for (let note = Math.ceil(middle - span / 2); note <= middle + span / 2; note++) {
      context.fillStyle = this.colours.line;
      context.fillRect(0, y(note), this.width, 1);
      context.fillStyle = this.colours.soft;
      if (span < 2 * OCTAVE) context.fillText(nameOf(note), 2, y(note));
    }
    context.globalAlpha = 0.4; // a band, on both sides of the line of what is played
    this.#line("heard", this.colours.accent, 8, x, y);
    context.globalAlpha = 1;
    this.#line("played", this.colours.outer, 2, x, y);
  }

  /**
   * @param {'heard' | 'played'} which
   * @param {string} colour
   * @param {number} width px
   * @param {(time: number) => number} x
   * @param {(pitch: number) => number} y
   */
  #line(which, colour, width, x, y) {
    const { context } = this;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    let last = NaN;
    for (const { time, [which]: pitch } of this.trace) {
      if (Math.abs(pitch - last) < 1) context.lineTo(x(time), y(pitch));
      else context.moveTo(x(time), y(pitch));
      last = pitch;
    }
    context.stroke();
  }
}
