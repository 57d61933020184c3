/** The spectrum of the sound, with the places of the note's partials. */

/** @typedef {import('./picture.js').Moment} Moment */

import { Picture, font } from "./picture.js";
import { soundingPitch } from "../sound/snapshot.js";

const LOWEST = 200; // Hz
const HIGHEST = 12000;
const FLOOR = -100; // dBFS
const TOP = -10;
const MARKS = /** @type {const} */ ([
  [250, "250"],
  [500, "500"],
  [1000, "1 k"],
  [2000, "2 k"],
  [4000, "4 k"],
  [8000, "8 k Hz"],
]);
const A4 = 440;

export class Spectrum extends Picture {
  /** @param {HTMLCanvasElement} canvas @param {() => AnalyserNode | null} analyser */
  constructor(canvas, analyser) {
    super(canvas);
    this.analyser = analyser;
    this.levels = new Float32Array(0);
  }

  /** @param {Moment} moment */
  draw({ state }) {
    const { context } = this;
    this.#frame();
    const analyser = this.analyser();
    if (!analyser || !state) return;
    if (this.levels.length !== analyser.frequencyBinCount) {
      this.levels = new Float32Array(analyser.frequencyBinCount);
    }
    analyser.getFloatFrequencyData(this.levels);
    const pitch = soundingPitch(state);
    if (!Number.isNaN(pitch)) this.#partials(A4 * 2 ** ((pitch - 69) / 12));
    this.#curve(analyser.context.sampleRate / analyser.fftSize);
  }

  /** @param {number} frequency Hz */
  #across(frequency) {
    return (Math.log(frequency / LOWEST) / Math.log(HIGHEST / LOWEST)) * this.width;
  }

  /** @param {number} level dBFS */
  #down(level) {
    return ((TOP - Math.min(Math.max(level, FLOOR), TOP)) / (TOP - FLOOR)) * (this.height - 18);
  }

  #frame() {
    const { context } = this;
    const bottom = this.height - 18;
    context.font = font(11);
    context.textBaseline = "top";
    context.textAlign = "center";
    for (const [frequency, text] of MARKS) {
      const x = this.#across(frequency);
      context.fillStyle = this.colours.line;
      context.fillRect(x, 0, 1, bottom);
      context.fillStyle = this.colours.soft;
      context.fillText(text, x, bottom + 4);
    }
    context.fillStyle = this.colours.line;
    context.fillRect(0, bottom, this.width, 1);
  }

  /** @param {number} fundamental Hz */
  #partials(fundamental) {
    const { context } = this;
    context.fillStyle = this.colours.outer;
    for (let n = 1; n * fundamental < HIGHEST && n <= 20; n++) {
      context.globalAlpha = 0.7 / Math.sqrt(n);
      context.fillRect(this.#across(n * fundamental) - 1, this.height - 18, 2, 5);
    }
    context.globalAlpha = 1;
  }

  /** The greatest level within each px. @param {number} step Hz from bin to bin */
  #curve(step) {
    const { context } = this;
    const bottom = this.height - 18;
    context.beginPath();
    context.moveTo(0, bottom);
    let bin = Math.floor(LOWEST / step);
    for (let x = 0; x <= this.width; x += 2) {
      const until = (LOWEST * (HIGHEST / LOWEST) ** ((x + 1) / this.width)) / step;
      let level = this.levels[Math.min(Math.round(until), this.levels.length - 1)];
      for (; bin < until && bin < this.levels.length; bin++)
        level = Math.max(level, this.levels[bin]);
      context.lineTo(x, this.#down(level));
    }
    context.lineTo(this.width, bottom);
    context.globalAlpha = 0.16;
    context.fillStyle = this.colours.outer;
    context.fill();
    context.globalAlpha = 1;
    context.strokeStyle = this.colours.outer;
    context.lineWidth = 1.3;
    context.stroke();
  }
}
