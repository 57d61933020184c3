/** The sound of this page: posts wishes to the instrument, and tells what it does. */

import facts from "../facts.js";
import { openBackend } from "./backends.js";
import { CHANNELS, WishBatch } from "./kernel.js";
import { snapshotOf, targetOf } from "./snapshot.js";
import { settings } from "../settings.js";

/** @typedef {import('../interfaces.js').Status} Status */
/** @typedef {import('./engine.js').Told} Told */

const USUAL_RATE = 48000;
const WATCH_MS = 500;
const LAG_S = 0.03; // by which sound falls behind the clock where samples were missing
const FFT = 4096;
const SUSPENDS_AFTER_MS = 10_000;
const FADE_S = 0.01;
// Of WAV files:
const FLOAT = 3; // the format's number
const BITS = 32;
const HEAD = 44; // bytes

export class Sound extends EventTarget {
  /**
   * Open the sound, all but its first touch: browsers keep silent before it.
   * @param {Promise<ArrayBuffer>} module the instrument in WebAssembly
   * @returns {Promise<Sound>}
   */
  static async open(module) {
    const context = newContext();
    try {
      const bytes = await module;
      const sound = new Sound(context);
      await sound.#connect(bytes);
      return sound;
    } catch (error) {
      await context.close();
      throw error;
    }
  }

  /** @param {AudioContext} context */
  constructor(context) {
    super();
    this.context = context;
    this.seen = new Float64Array(facts.lookLength);
    this.state = snapshotOf(this.seen);
    this.analyser = new AnalyserNode(context, { fftSize: FFT, smoothingTimeConstant: 0.6 });
    this.gain = new GainNode(context, { gain: 1 });
    this.loadPercent = 0;
    this.isAsleep = false; // nothing sounds, and nothing is computed
    this.suspending = 0; // timer
    this.dropouts = 0;
    this.post = new WishBatch((wishes) => this.#send(wishes)).post;
    /** @type {Float32Array[] | null} */
    this.chunks = null;
    /** @type {((blob: Blob) => void) | null} */
    this.recorded = null;
    this.record = { start: () => this.#startRecording(), stop: () => this.#stopRecording() };
    /** @type {((kept: NonNullable<Told["kept"]>) => void) | null} */
    this.kept = null;
    this.heard = NaN; // pitch of a voice that is followed
    this.voice = { start: () => this.#startVoice(), stop: () => this.#stopVoice() };
    /** @type {MediaStreamAudioSourceNode | null} */
    this.microphone = null;
    this.keep = {
      start: () => this.backend?.take({ keep: true }),
      stop: () => this.#stopKeeping(),
    };
    this.#watch();
  }

  /** @param {ArrayBuffer} bytes */
  async #connect(bytes) {
    this.backend = await openBackend(this.context, bytes, facts.lookLength, (told) =>
      this.#hear(told),
    );
    this.backend.node.connect(this.gain).connect(this.analyser).connect(this.context.destination);
  }

  /** @param {Float64Array<ArrayBuffer>} wishes */
  #send(wishes) {
    clearTimeout(this.suspending);
    if (this.isAsleep) this.resume();
    this.backend?.take({ wishes }, [wishes.buffer]);
  }

  /** @param {string} address of a parameter of bow or fingers */
  target(address) {
    return targetOf(this.seen, address);
  }

  /** @returns {Status} */
  get status() {
    const { baseLatency = 0, outputLatency = 0, sampleRate, state } = this.context;
    return {
      backend: this.backend?.name ?? "worklet",
      rate: sampleRate,
      loadPercent: this.loadPercent,
      latencyMs: 1e3 * (baseLatency + outputLatency),
      dropouts: this.dropouts,
      running: state === "running" || this.isAsleep,
    };
  }

  /** Go on after the browser has suspended it. */
  resume() {
    this.isAsleep = false;
    return this.context.resume();
  }

  /** Nothing sounds: after a while the device may rest too, until something is asked for. */
  #sleep() {
    this.loadPercent = 0;
    this.suspending = window.setTimeout(() => {
      if (this.microphone) return; // it would hear nothing any more
      this.isAsleep = true;
      this.context.suspend();
    }, SUSPENDS_AFTER_MS);
  }

  close() {
    this.#stopVoice();
    clearInterval(this.watching);
    const end = this.context.currentTime + FADE_S;
    this.gain.gain.linearRampToValueAtTime(0, end);
    setTimeout(() => {
      this.backend?.close();
      this.context.close();
    }, 2e3 * FADE_S);
  }

  /** @param {Told} told */
  #hear({ seen, sleeps, load, recorded, isLast, kept, heard = NaN }) {
    if (seen) this.heard = heard;
    if (sleeps) this.#sleep();
    if (kept) this.kept?.(kept);
    if (recorded && this.chunks) {
      this.chunks.push(recorded);
      if (isLast) {
        this.recorded?.(wav(this.chunks, this.context.sampleRate, CHANNELS));
        this.chunks = this.recorded = null;
      }
    }
    if (load !== undefined) this.loadPercent = 100 * load;
    if (seen) {
      this.seen.set(seen);
      this.state = snapshotOf(this.seen);
      this.backend?.take({ seen }, [/** @type {ArrayBuffer} */ (seen.buffer)]);
      this.dispatchEvent(new Event("state"));
    }
  }

  /** Follow a microphone, once whoever sings has agreed; what browsers do to speech is of no use. */
  async #startVoice() {
    const stream = await navigator.mediaDevices.getUserMedia({
      audio: { echoCancellation: false, noiseSuppression: false, autoGainControl: false },
    });
    this.microphone = this.context.createMediaStreamSource(stream);
    if (this.backend) this.microphone.connect(this.backend.node);
    this.backend?.take({ voice: true });
    await this.resume();
  }

  #stopVoice() {
    clearTimeout(this.suspending); // it may have begun before the voice did
    this.microphone?.disconnect();
    for (const track of this.microphone?.mediaStream.getTracks() ?? []) track.stop();
    this.microphone = null;
    this.backend?.take({ voice: false });
  }

  #startRecording() {
    this.chunks = [];
    this.backend?.take({ record: true });
  }

  /** @returns {Promise<Blob>} */
  #stopRecording() {
    return new Promise((resolve) => {
      this.recorded = resolve;
      this.backend?.take({ record: false });
    });
  }

  /** @returns {Promise<NonNullable<Told["kept"]>>} */
  #stopKeeping() {
    return new Promise((resolve) => {
      this.kept = resolve;
      this.backend?.take({ keep: false });
    });
  }

  /** Count the times when the sound fell behind the clock. */
  #watch() {
    let before = this.#lag();
    let wasRunning = false;
    this.watching = setInterval(() => {
      const now = this.#lag();
      const isRunning = this.context.state === "running";
      if (isRunning && wasRunning && !document.hidden && now - before > LAG_S) {
        this.dropouts += 1;
      }
      before = now;
      wasRunning = isRunning;
    }, WATCH_MS);
  }

  #lag() {
    return performance.now() / 1e3 - this.context.currentTime;
  }
}

function newContext() {
  const latencyHint = settings.isBuffered ? "playback" : "interactive";
  const context = new AudioContext({ latencyHint });
  if (facts.rates.includes(context.sampleRate)) return context;
  context.close();
  return new AudioContext({ latencyHint, sampleRate: USUAL_RATE });
}

/**
 * A WAV file of 32-bit floats, as they were heard.
 * @param {Float32Array[]} chunks of samples, of all channels in turn
 * @param {number} rate in Hz
 * @param {number} channels
 */
function wav(chunks, rate, channels) {
  const frameBytes = (channels * BITS) / 8;
  const bytes = 4 * chunks.reduce((sum, chunk) => sum + chunk.length, 0);
  const view = new DataView(new ArrayBuffer(HEAD));
  /** @param {number} at @param {string} text */
  const write = (at, text) =>
    [...text].forEach((letter, i) => view.setUint8(at + i, letter.charCodeAt(0)));
  write(0, "RIFF");
  view.setUint32(4, HEAD - 8 + bytes, true);
  write(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, FLOAT, true);
  view.setUint16(22, channels, true);
  view.setUint32(24, rate, true);
  view.setUint32(28, rate * frameBytes, true);
  view.setUint16(32, frameBytes, true);
  view.setUint16(34, BITS, true);
  write(36, "data");
  view.setUint32(40, bytes, true);
  return new Blob([view, .../** @type {BlobPart[]} */ (chunks)], { type: "audio/wav" });
}
