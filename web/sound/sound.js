/** The sound of this page: posts commands to the instrument, and reports what it does. */

import facts from "../facts.js";
import { Engine } from "./engine.js";
import { CHANNELS, CommandBatch } from "./kernel.js";
import { Output } from "./output.js";
import { snapshotOf, targetOf } from "./snapshot.js";
import { settings } from "../settings.js";

/** @typedef {import('../interfaces.js').Status} Status */
/** @typedef {import('./engine.js').Take} Take */
/** @typedef {import('./engine.js').Report} Report */

const USUAL_RATE = 48000;
const WATCH_MS = 500;
const LAG_S = 0.03; // by which sound falls behind the clock where samples were missing
const SUSPENDS_AFTER_MS = 10_000;
const FLOAT = 3; // the number of that format in WAV files

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
    this.seen = new Float64Array(facts.snapshotLength);
    this.state = snapshotOf(this.seen);
    this.output = new Output(context);
    this.analyser = this.output.analyser;
    /** Where there is no worklet. @type {Engine | null} */
    this.engine = null;
    this.loadPercent = 0;
    this.isAsleep = false; // nothing sounds, and nothing is computed
    this.suspending = 0; // timer
    this.dropouts = 0;
    this.post = new CommandBatch((commands) => this.#send(commands)).post;
    /** @type {Float32Array[] | null} */
    this.chunks = null;
    /** @type {((blob: Blob) => void) | null} */
    this.recorded = null;
    this.record = { start: () => this.#startRecording(), stop: () => this.#stopRecording() };
    /** @type {((kept: NonNullable<Report["kept"]>) => void) | null} */
    this.kept = null;
    this.heard = NaN; // pitch of a voice that is followed
    this.voice = {
      start: () => this.#startVoice(),
      follow: (/** @type {number[]} */ tuning) => this.#take({ voice: tuning }),
      stop: () => this.#stopVoice(),
    };
    /** @type {MediaStreamAudioSourceNode | null} */
    this.microphone = null;
    this.keep = {
      start: () => this.#take({ keep: true }),
      stop: () => this.#stopKeeping(),
    };
    this.#watch();
  }

  /** @param {ArrayBuffer} bytes */
  async #connect(bytes) {
    const { snapshotLength } = facts;
    const { sampleRate } = this.context;
    await this.output.connect({
      name: "yehu",
      file: "processor.js",
      inputs: 1, // a voice
      options: { bytes, snapshotLength },
      make: (frames) => {
        const hear = (/** @type {Report} */ report) => this.#hear(report);
        const engine = (this.engine = new Engine(bytes, sampleRate, frames, snapshotLength, hear));
        return (left, right) => engine.fill(left, right);
      },
    });
    const { port } = this.output;
    if (port) port.onmessage = ({ data }) => this.#hear(data);
  }

  /** @param {Take} message @param {Transferable[]} [buffers] */
  #take(message, buffers = []) {
    this.engine?.take(message);
    this.output.port?.postMessage(message, buffers);
  }

  /** @param {Float64Array<ArrayBuffer>} commands */
  #send(commands) {
    clearTimeout(this.suspending);
    if (this.isAsleep) this.resume();
    this.#take({ commands }, [commands.buffer]);
  }

  /** @param {string} address of a parameter of bow or fingers */
  target(address) {
    return targetOf(this.seen, address);
  }

  /** @returns {Status} */
  get status() {
    const { sampleRate, state } = this.context;
    return {
      backend: this.engine ? "script" : "worklet",
      rate: sampleRate,
      loadPercent: this.loadPercent,
      latencyMs: this.output.latencyMs,
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
    this.output.close();
  }

  /** @param {Report} report */
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
      this.#take({ seen }, [/** @type {ArrayBuffer} */ (seen.buffer)]);
      this.dispatchEvent(new Event("state"));
    }
  }

  /** Follow a microphone, once whoever sings has agreed; what browsers do to speech is of no use. */
  async #startVoice() {
    const stream = await navigator.mediaDevices.getUserMedia({
      audio: { echoCancellation: false, noiseSuppression: false, autoGainControl: false },
    });
    this.microphone = this.context.createMediaStreamSource(stream);
    if (this.output.node) this.microphone.connect(this.output.node);
    await this.resume();
  }

  #stopVoice() {
    clearTimeout(this.suspending); // it may have begun before the voice did
    this.microphone?.disconnect();
    for (const track of this.microphone?.mediaStream.getTracks() ?? []) track.stop();
    this.microphone = null;
    this.#take({ voice: null });
  }

  #startRecording() {
    this.chunks = [];
    this.#take({ record: true });
  }

  /** @returns {Promise<Blob>} */
  #stopRecording() {
    return new Promise((resolve) => {
      this.recorded = resolve;
      this.#take({ record: false });
    });
  }

  /** @returns {Promise<NonNullable<Report["kept"]>>} */
  #stopKeeping() {
    return new Promise((resolve) => {
      this.kept = resolve;
      this.#take({ keep: false });
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
  const bytes = 4 * chunks.reduce((sum, chunk) => sum + chunk.length, 0);
  const frame = 4 * channels; // bytes
  // Numbers have their lowest byte first, as in all browsers.
  const long = (/** @type {number[]} */ ...numbers) => Uint32Array.from(numbers);
  const short = (/** @type {number[]} */ ...numbers) => Uint16Array.from(numbers);
  const format = [long(16), short(FLOAT, channels), long(rate, rate * frame), short(frame, 32)];
  const head = ["RIFF", long(36 + bytes), "WAVEfmt ", ...format, "data", long(bytes)];
  const samples = /** @type {BlobPart[]} */ (chunks);
  return new Blob([...head, ...samples], { type: "audio/wav" });
}
