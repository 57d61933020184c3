/**
 * The instrument in WebAssembly: post commands, compute samples, take snapshots.
 *
 * It is the server's audio callback, compiled ahead of time. It runs in an audio worklet, on the
 * page's own thread, and in Node.
 */

const PAGE_BYTES = 65536; // of WebAssembly's memory
const ALIGNED = 64; // bytes
const SECOND_NS = 1_000_000_000n;
const KEYS = 128; // of a tuning

/** Commands for the frame that is computed next, whichever it is, have this one. */
export const NOW = -1;

/** Left and right, in turn. */
export const CHANNELS = 2;

/** Numbers of a command in a message: frame or NOW, kind, index, value, other. */
export const COMMAND = 5;

/** Gathers the commands of one turn of the page, which go together. */
export class CommandBatch {
  /** @type {number[]} */
  #numbers = [];

  /** @param {(commands: Float64Array<ArrayBuffer>) => void} send */
  constructor(send) {
    this.send = send;
  }

  /** Post a command; `frame` null is now. @type {import('../interfaces.js').Post} */
  post = (frame, kind, index, value, other) => {
    if (this.#numbers.length === 0) {
      queueMicrotask(() => this.send(Float64Array.from(this.#numbers.splice(0))));
    }
    this.#numbers.push(frame ?? NOW, kind, index, value, other);
  };
}

/** Numbers of a command of a voice, which has no frame; and the most of a block. */
export const VOICE_COMMAND = COMMAND - 1;
const VOICE_COMMANDS = 64;

/** What the module needs of its surroundings. @param {() => DataView} view of its memory */
export function wasmImports(view) {
  return {
    asin: Math.asin,
    sin: Math.sin,
    cos: Math.cos,
    tan: Math.tan,
    tanh: Math.tanh,
    sqrt: Math.sqrt,
    exp: Math.exp,
    log: Math.log,
    log2: Math.log2,
    log10: Math.log10,
    pow: Math.pow,
    exp2: (/** @type {number} */ x) => 2 ** x,
    /** C's clock, for the meters that only a server shows. */
    clock_gettime: (/** @type {number} */ _clock, /** @type {number} */ into) => {
      const ns = BigInt(Math.round(Date.now())) * 1_000_000n;
      view().setBigInt64(into, ns / SECOND_NS, true);
      view().setBigInt64(into + 8, ns % SECOND_NS, true);
      return 0;
    },
  };
}

/**
 * Room in the module's memory, behind what it has for itself.
 * @param {any} exported by the module
 * @param {number[]} sizes of some pieces, in bytes
 * @returns {number[]} where each begins
 */
export function room(exported, ...sizes) {
  let end = exported.__heap_base.value;
  const places = sizes.map((size) => {
    const at = Math.ceil(end / ALIGNED) * ALIGNED;
    end = at + size;
    return at;
  });
  const missing = end - exported.memory.buffer.byteLength;
  if (missing > 0) exported.memory.grow(Math.ceil(missing / PAGE_BYTES));
  return places;
}

export class Kernel {
  /**
   * @param {WebAssembly.Module} module
   * @param {number} rate in Hz; one that the module was built for
   * @param {number} most frames of a block
   * @param {number} snapshotLength numbers of a snapshot
   */
  constructor(module, rate, most, snapshotLength) {
    /** @type {any} */
    const exported = new WebAssembly.Instance(module, {
      env: wasmImports(() => this.view),
    }).exports;
    this.exported = exported;
    this.most = most;
    const [rig, out, snapshot, voice, sung, commands] = room(
      exported,
      Number(exported.yehu_size()),
      4 * CHANNELS * most,
      8 * snapshotLength,
      Number(exported.yehu_voice_size()),
      4 * most,
      8 * VOICE_COMMAND * VOICE_COMMANDS,
    );
    this.at = { rig, out, snapshot, voice, sung, commands };
    const memory = exported.memory.buffer; // it grows no more
    this.view = new DataView(memory);
    this.out = new Float32Array(memory, out, CHANNELS * most);
    this.seen = new Float64Array(memory, snapshot, snapshotLength);
    this.sung = new Float32Array(memory, sung, most);
    this.sungCommands = new Float64Array(memory, commands, VOICE_COMMAND * VOICE_COMMANDS);
    this.lengths = Array.from({ length: most + 1 }, (_, frames) => BigInt(frames));
    if (exported.yehu_prepare(this.at.rig, rate, BigInt(CHANNELS)) === 0n) {
      throw new RangeError(`the instrument was not built for ${rate} Hz`);
    }
  }

  /** Hash of the sources that it was built from (16 hex digits). */
  get sources() {
    return BigInt.asUintN(64, this.exported.yehu_sources()).toString(16).padStart(16, "0");
  }

  /** Number of the next frame. */
  get frame() {
    return Number(this.exported.yehu_frame(this.at.rig));
  }

  /** How often the state was lost; it should stay 0. */
  get lost() {
    return Number(this.exported.yehu_lost(this.at.rig));
  }

  /** The value that a parameter has, or moves to. @param {number} index */
  value(index) {
    return this.exported.yehu_value(this.at.rig, BigInt(index));
  }

  /**
   * Post a command; see the table of kinds. Returns whether there was room for it.
   * @param {number} frame or NOW
   * @param {number} kind
   * @param {number} index
   * @param {number} value
   * @param {number} other
   */
  post(frame, kind, index, value, other) {
    const at = frame === NOW ? this.exported.yehu_frame(this.at.rig) : BigInt(frame);
    return (
      this.exported.yehu_post(this.at.rig, at, BigInt(kind), BigInt(index), value, other) !== 0n
    );
  }

  /**
   * Compute the next frames, at most `most`, into the beginning of `out`.
   * @param {number} frames
   */
  compute(frames) {
    this.exported.yehu_process(this.at.rig, this.at.out, this.lengths[frames]);
  }

  /**
   * Follow a voice from now on.
   * @param {number} rate in Hz
   * @param {number[]} tuning pitches that it is moved to; none: it is played as it is sung
   */
  prepareVoice(rate, tuning) {
    const bytes = Number(this.exported.yehu_voice_size());
    new Uint8Array(this.exported.memory.buffer, this.at.voice, bytes).fill(0);
    this.exported.yehu_voice_prepare(this.at.voice, rate, NaN, tuning.length ? 1 : 0);
    for (let key = 0; key < KEYS; key++) {
      this.exported.yehu_voice_tune(this.at.voice, BigInt(key), tuning[key] ?? NaN);
    }
  }

  /**
   * The commands that the next samples of a voice result in: VOICE_COMMAND numbers each. No samples end
   * its note.
   * @param {Float32Array} samples at most `most`
   */
  follow(samples) {
    this.sung.set(samples);
    const { voice, sung, commands } = this.at;
    const count = this.exported.yehu_follow_voice(
      voice, sung, BigInt(samples.length), commands, BigInt(VOICE_COMMANDS),
    ); // prettier-ignore
    return this.sungCommands.subarray(0, VOICE_COMMAND * Number(count));
  }

  /** The pitch of the voice, or NaN. */
  get voicePitch() {
    return this.exported.yehu_voice_pitch(this.at.voice);
  }

  /** Take a snapshot: fills `seen`. */
  snapshot() {
    this.exported.yehu_snapshot(this.at.rig, this.at.snapshot);
    return this.seen;
  }
}
