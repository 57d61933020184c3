/**
 * The instrument in WebAssembly: post wishes, compute samples, look at it.
 *
 * It is the very callback of the server, compiled ahead of time. It runs in an audio worklet, on the
 * page's own thread, and in Node.
 */

const PAGE_BYTES = 65536; // of WebAssembly's memory
const ALIGNED = 64; // bytes
const SECOND_NS = 1_000_000_000n;

/** Wishes for the frame that is computed next, whichever it is, have this one. */
export const NOW = -1;

/** Left and right, in turn. */
export const CHANNELS = 2;

/** Numbers of a wish in a message: frame or NOW, kind, index, value, other. */
export const WISH = 5;

/**
 * What the module needs of its surroundings.
 * @param {() => DataView} view of its memory
 */
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
   * @param {number} lookLength numbers of a look
   */
  constructor(module, rate, most, lookLength) {
    /** @type {any} */
    const exported = new WebAssembly.Instance(module, {
      env: wasmImports(() => this.view),
    }).exports;
    this.exported = exported;
    this.most = most;
    const sizes = [Number(exported.yehu_size()), 4 * CHANNELS * most, 8 * lookLength];
    const [rig, outAt, lookAt] = room(exported, ...sizes);
    this.rig = rig;
    this.outAt = outAt;
    this.lookAt = lookAt;
    const memory = exported.memory.buffer; // it grows no more
    this.view = new DataView(memory);
    this.out = new Float32Array(memory, this.outAt, CHANNELS * most);
    this.seen = new Float64Array(memory, this.lookAt, lookLength);
    this.lengths = Array.from({ length: most + 1 }, (_, frames) => BigInt(frames));
    if (exported.yehu_prepare(this.rig, rate, BigInt(CHANNELS)) === 0n) {
      throw new RangeError(`the instrument was not built for ${rate} Hz`);
    }
  }

  /** Hash of the sources that it was built from (16 hex digits). */
  get sources() {
    return BigInt.asUintN(64, this.exported.yehu_sources()).toString(16).padStart(16, "0");
  }

  /** Number of the next frame. */
  get frame() {
    return Number(this.exported.yehu_frame(this.rig));
  }

  /** How often the state was lost; it should stay 0. */
  get lost() {
    return Number(this.exported.yehu_lost(this.rig));
  }

  /**
   * The value that a parameter has, or moves to.
   * @param {number} row
   */
  value(row) {
    return this.exported.yehu_value(this.rig, BigInt(row));
  }

  /**
   * Post a wish; see the table of kinds. Returns whether there was room for it.
   * @param {number} frame or NOW
   * @param {number} kind
   * @param {number} index
   * @param {number} value
   * @param {number} other
   */
  post(frame, kind, index, value, other) {
    const at = frame === NOW ? this.exported.yehu_frame(this.rig) : BigInt(frame);
    return this.exported.yehu_post(this.rig, at, BigInt(kind), BigInt(index), value, other) !== 0n;
  }

  /**
   * Compute the next frames, at most `most`, into the beginning of `out`.
   * @param {number} frames
   */
  compute(frames) {
    this.exported.yehu_process(this.rig, this.outAt, this.lengths[frames]);
  }

  /** Look at the instrument: fills `seen`. */
  look() {
    this.exported.yehu_look(this.rig, this.lookAt);
    return this.seen;
  }
}
