/**
 * The instrument as a page runs it: in an audio worklet, or on the page's own thread.
 * It takes messages and posts others.
 */

import { CHANNELS, Kernel, NOW, VOICE_COMMAND, COMMAND } from "./kernel.js";

const SNAPSHOTS_A_SECOND = 60;
const CHUNK = 4096; // recorded frames that are posted at a time
const FAINT = 1e-3; // of full scale; what is fainter dies away within the time that follows
const SLEEPS_AFTER_S = 4; // without a command or a sound
const MAX_SNAPSHOTS = 4; // that nobody has given back yet; then no page reads them

/**
 * @typedef {object} Take
 * @property {Float64Array} [commands] COMMAND numbers each
 * @property {boolean} [record] begins or ends a recording
 * @property {boolean} [keep] begins or ends keeping the commands that are applied
 * @property {Float64Array} [seen] a snapshot, given back
 * @property {number[] | null} [voice] begins following a voice, moved to these pitches if there are
 *   any; null ends it
 *
 * @typedef {object} Report
 * @property {Float64Array} [seen] a snapshot
 * @property {number} [heard] pitch of the voice, where one is followed; NaN for none
 * @property {boolean} [sleeps] whether it has just gone to sleep
 * @property {number} [load] share of the time that computing takes
 * @property {Float32Array} [recorded] samples, left and right in turn
 * @property {boolean} [isLast] of a recording
 * @property {{from: number, to: number, commands: number[]}} [kept] frames, and COMMAND numbers each
 */

export class Engine {
  /**
   * @param {BufferSource} bytes of the WebAssembly module
   * @param {number} rate in Hz
   * @param {number} most frames of a block
   * @param {number} snapshotLength numbers of a snapshot
   * @param {(report: Report, buffers: ArrayBufferLike[]) => void} post
   */
  constructor(bytes, rate, most, snapshotLength, post) {
    this.kernel = new Kernel(new WebAssembly.Module(bytes), rate, most, snapshotLength);
    this.rate = rate;
    this.post = post;
    /** @type {Float64Array[]} */
    this.free = Array.from({ length: MAX_SNAPSHOTS }, () => new Float64Array(snapshotLength));
    this.nextSnapshot = 0;
    this.frame = 0;
    this.restless = 0; // frame until which something was asked for, or sounded
    this.sleeps = true; // no command has come yet
    this.busyMs = 0;
    this.measuredFrom = 0;
    /** @type {Float32Array | null} */
    this.chunk = null;
    this.filled = 0;
    /** @type {number[] | null} */
    this.kept = null;
    this.keptFrom = 0;
    this.follows = false;
  }

  /** @param {Take} message */
  take({ commands, record, keep, seen, voice }) {
    if (seen) this.free.push(seen);
    if (voice !== undefined) this.#follow(voice);
    if (commands) {
      this.sleeps = false;
      this.restless = this.frame;
      for (let i = 0; i < commands.length; i += COMMAND) {
        this.#post(commands[i], commands.subarray(i + 1, i + COMMAND));
      }
    }
    if (keep === true) [this.kept, this.keptFrom] = [[], this.frame];
    else if (keep === false && this.kept) {
      this.post({ kept: { from: this.keptFrom, to: this.frame, commands: this.kept } }, []);
      this.kept = null;
    }
    if (record === true) {
      this.chunk = new Float32Array(CHANNELS * CHUNK);
      this.filled = 0;
    } else if (record === false) this.#endRecording();
  }

  /** @param {number} frame or NOW @param {Float64Array} command kind, index, value, other */
  #post(frame, command) {
    const isTaken = this.kernel.post(frame, command[0], command[1], command[2], command[3]);
    this.restless = Math.max(this.restless, frame);
    if (isTaken && this.kept) this.kept.push(Math.max(frame, this.frame), ...command);
  }

  /** @param {number[] | null} tuning of the voice to follow from now on; null for none */
  #follow(tuning) {
    if (this.follows) {
      this.hear(new Float32Array(0));
      this.sleeps = false; // it reports anew that it sleeps, as the device may rest then
      this.restless = this.frame;
    }
    if (tuning) this.kernel.prepareVoice(this.rate, tuning);
    this.follows = tuning !== null;
  }

  /** Follow a voice, where one is followed. @param {Float32Array} samples at most a block */
  hear(samples) {
    if (!this.follows) return;
    const commands = this.kernel.follow(samples);
    if (commands.length) {
      this.sleeps = false;
      this.restless = this.frame;
    }
    for (let i = 0; i < commands.length; i += VOICE_COMMAND) {
      this.#post(NOW, commands.subarray(i, i + VOICE_COMMAND));
    }
  }

  /**
   * Compute the next frames; none while it sleeps, for which its time stands still.
   * @param {Float32Array} left
   * @param {Float32Array} right as long
   */
  fill(left, right) {
    if (this.sleeps && !this.chunk && !this.kept) {
      left.fill(0);
      right.fill(0);
      return;
    }
    const began = Date.now(); // worklets have no finer clock; its mean is right
    const frames = left.length;
    const { out } = this.kernel;
    this.kernel.compute(frames);
    for (let n = 0; n < frames; n++) {
      left[n] = out[CHANNELS * n];
      right[n] = out[CHANNELS * n + 1];
      if (Math.abs(left[n]) + Math.abs(right[n]) > FAINT) this.restless = this.frame;
    }
    this.frame += frames;
    if (this.frame > this.restless + SLEEPS_AFTER_S * this.rate && !this.sleeps) this.#sleep();
    if (this.chunk) this.#record(frames);
    if (this.frame >= this.nextSnapshot) this.#snapshot();
    this.busyMs += Date.now() - began;
  }

  #sleep() {
    this.sleeps = true;
    this.busyMs = 0;
    this.measuredFrom = this.frame;
    this.post({ sleeps: true }, []);
  }

  #snapshot() {
    this.nextSnapshot = this.frame + this.rate / SNAPSHOTS_A_SECOND;
    const seen = this.free.pop();
    if (!seen) return;
    seen.set(this.kernel.snapshot());
    /** @type {Report} */
    const report = { seen };
    if (this.follows) report.heard = this.kernel.voicePitch;
    const measured = this.frame - this.measuredFrom;
    if (measured >= this.rate) {
      report.load = (1e-3 * this.busyMs * this.rate) / measured;
      this.measuredFrom = this.frame;
      this.busyMs = 0;
    }
    this.post(report, [seen.buffer]);
  }

  /** @param {number} frames that were computed */
  #record(frames) {
    for (let i = 0; i < CHANNELS * frames; i++) {
      if (!this.chunk) return;
      this.chunk[this.filled] = this.kernel.out[i];
      this.filled += 1;
      if (this.filled === this.chunk.length) {
        const recorded = this.chunk;
        this.chunk = new Float32Array(CHANNELS * CHUNK);
        this.filled = 0;
        this.post({ recorded }, [recorded.buffer]);
      }
    }
  }

  #endRecording() {
    if (!this.chunk) return;
    const recorded = this.chunk.slice(0, this.filled);
    this.chunk = null;
    this.post({ recorded, isLast: true }, [recorded.buffer]);
  }
}
