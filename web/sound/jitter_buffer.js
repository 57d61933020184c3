/**
 * Sound that comes in pieces from another clock: it waits in a ring, and is read a little faster or
 * slower than it was made, so that the ring stays equally full.
 */

import { CHANNELS } from "./kernel.js";

const RING = 1 << 15; // frames; a power of two
const LEAST = 512; // frames of fill to aim at, at first; more after the sound has run out
const MOST = 1 << 13;
const GROWTH = 1.5;
const SHRINK_S = 20; // after which an aim that held is a little lower
const SHRINKING = 0.9;
const TAPS = 16;
const PHASES = 256;
const FADE = 64; // frames
// The reading's speed follows the fill, averaged over AVERAGE_S, by P and the I part, in 1/s, 1/s².
const AVERAGE_S = 0.5;
const P = 0.2;
const I = 0.02;
const MAX_DRIFT = 0.005;
const TOO_FULL_S = 0.06; // above the aim: then some is left out

/** Windowed sincs, by phase. */
const SINCS = Array.from({ length: PHASES + 1 }, (_, phase) =>
  Float64Array.from({ length: TAPS }, (_, tap) => {
    const x = tap - TAPS / 2 + 1 - phase / PHASES;
    const window = 0.5 + 0.5 * Math.cos((2 * Math.PI * x) / TAPS);
    return (x === 0 ? 1 : Math.sin(Math.PI * x) / (Math.PI * x)) * window;
  }),
);

export class JitterBuffer {
  /** @param {number} rate of what is read, in Hz @param {number} sourceRate of what is written */
  constructor(rate, sourceRate = rate) {
    this.rate = rate;
    this.sourceRate = sourceRate;
    this.ring = new Float32Array(CHANNELS * RING);
    this.written = 0; // frames, so far
    this.read = 0; // and with a fraction
    this.aim = LEAST;
    this.isRunning = false;
    this.average = 0; // of the error of the fill, in s
    this.sum = 0; // of it over time, in s²
    this.drift = 0;
    this.gain = 0;
    this.gaps = 0;
    this.steadyS = 0; // since the last gap
    this.next = -1; // frame that should come next
    this.between = new Float64Array(CHANNELS);
  }

  /** Frames that wait. */
  get fill() {
    return this.written - this.read;
  }

  /**
   * @param {number} frame number of the first
   * @param {Float32Array} samples left and right in turn
   */
  write(frame, samples) {
    if (this.next >= 0 && frame !== this.next && this.isRunning) this.gaps += 1;
    this.next = frame + samples.length / CHANNELS;
    const most = (CHANNELS * RING) / 2;
    const kept = samples.length > most ? samples.subarray(samples.length - most) : samples;
    const start = CHANNELS * this.written;
    for (let i = 0; i < kept.length; i++) this.ring[(start + i) & (CHANNELS * RING - 1)] = kept[i];
    this.written += kept.length / CHANNELS;
    if (this.fill > this.aim + TOO_FULL_S * this.sourceRate) this.#begin();
  }

  /** Go to where the fill is as it should be. */
  #begin() {
    this.read = this.written - this.aim;
    this.average = 0;
    this.gain = 0; // fades in
  }

  /**
   * Read the next frames; silence while too few wait.
   * @param {Float32Array} left
   * @param {Float32Array} right as long
   */
  fillIn(left, right) {
    if (!this.isRunning && this.fill >= this.aim) {
      this.#begin();
      this.isRunning = true;
    }
    const step = this.isRunning ? this.#follow(left.length / this.rate) : 0;
    for (let i = 0; i < left.length; i++) {
      if (this.isRunning && this.fill < TAPS / 2 + step) this.#stop();
      if (!this.isRunning) {
        left[i] = right[i] = 0;
        continue;
      }
      this.gain = Math.min(1, this.gain + 1 / FADE);
      this.#interpolate();
      left[i] = this.gain * this.between[0];
      right[i] = this.gain * this.between[1];
      this.read += step;
    }
  }

  /** The sound ran out: more has to wait before it goes on. */
  #stop() {
    this.isRunning = false;
    this.gaps += 1;
    this.steadyS = 0;
    this.aim = Math.min(MOST, Math.round(this.aim * GROWTH));
  }

  /** Find the frames to go on for each that is read. @param {number} seconds that it is for */
  #follow(seconds) {
    const error = (this.fill - this.aim) / this.sourceRate;
    this.average += (error - this.average) * Math.min(1, seconds / AVERAGE_S);
    const most = MAX_DRIFT / I;
    this.sum = Math.min(most, Math.max(-most, this.sum + this.average * seconds));
    const drift = P * this.average + I * this.sum;
    this.drift = Math.min(MAX_DRIFT, Math.max(-MAX_DRIFT, drift));
    this.steadyS += seconds;
    if (this.steadyS > SHRINK_S && this.aim > LEAST) {
      this.aim = Math.max(LEAST, Math.round(this.aim * SHRINKING));
      this.steadyS = 0;
    }
    return (this.sourceRate / this.rate) * (1 + this.drift);
  }

  /** Find the sound between its samples: fills `between`. */
  #interpolate() {
    const whole = Math.floor(this.read);
    const place = (this.read - whole) * PHASES;
    const phase = Math.floor(place);
    const share = place - phase;
    const one = SINCS[phase];
    const other = SINCS[phase + 1];
    let [left, right] = [0, 0];
    for (let tap = 0; tap < TAPS; tap++) {
      const weight = one[tap] + share * (other[tap] - one[tap]);
      const at = CHANNELS * ((whole + tap - TAPS / 2 + 1) & (RING - 1));
      left += weight * this.ring[at];
      right += weight * this.ring[at + 1];
    }
    this.between[0] = left;
    this.between[1] = right;
  }
}
