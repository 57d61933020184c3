/**
 * Makes commands of MIDI, mappings and hands: the server's own code, in WebAssembly, on the page's thread.
 *
 * Events go in (`facts.events`), and commands come out (`facts.kinds`).
 */

import facts from "../facts.js";
import { room, wasmImports } from "../sound/kernel.js";

const { record, tablesAt, length, slots } = facts.interpreter;
const HALVES = 2; // of a whole number, whose lower one holds all that pages read

/** @typedef {[kind: number, index: number, value: number, other: number]} Requested */

export class Interpreter {
  /**
   * Make one of a part that was sent nothing, and has no tables yet.
   * @param {BufferSource} bytes of the WebAssembly module
   * @returns {Promise<Interpreter>}
   */
  static async open(bytes) {
    /** @type {any} */
    let exported = null;
    const env = wasmImports(() => new DataView(exported.memory.buffer));
    exported = (await WebAssembly.instantiate(bytes, { env })).instance.exports;
    return new Interpreter(exported);
  }

  /** @param {any} exported by the module */
  constructor(exported) {
    const [at] = room(exported, Number(exported.yehu_interpreter_size()));
    exported.yehu_interpreter_prepare(at);
    this.exported = exported;
    this.at = at;
    const memory = exported.memory.buffer; // it grows no more
    this.numbers = new Float64Array(memory, at);
    this.halves = new Int32Array(memory, at);
    /** The values of parameters, by index. */
    this.values = this.#of(record.value);
    /** The last values of binds, by index; the size of a section is not limited here. */
    this.found = this.#of(record.resolved_value);
  }

  /** @param {number[]} field */
  #of([at, size]) {
    return this.numbers.subarray(at, at + size);
  }

  /**
   * Whether notes and controllers give a parameter its value, or it was set.
   * @param {number} index
   */
  isTarget(index) {
    return this.#whole(record.is_target, index) !== 0;
  }

  /** @param {number[]} field */
  #whole([at], place = 0) {
    return this.halves[HALVES * (at + place)];
  }

  /** The number of the tables that are used next after those in use. */
  get nextSlot() {
    return (this.#whole(record.tables) + 1) % slots;
  }

  /** Some tables: see `writeTables`. @param {number} [slot] by default those in use */
  tables(slot = this.#whole(record.tables)) {
    return this.#of([tablesAt + slot * length, length]);
  }

  /**
   * Interpret an event; return the commands that result.
   * @param {number} frame
   * @param {number} kind
   * @param {number} index
   * @param {number} value
   * @param {number} other
   * @returns {Requested[]}
   */
  take(frame, kind, index, value, other) {
    const { out_kind, out_index, out_value, out_other } = record;
    const whole = [frame, kind, index].map(BigInt);
    const count = this.exported.yehu_interpreter_take(this.at, ...whole, value, other);
    return Array.from({ length: Number(count) }, (_, place) => [
      this.#whole(out_kind, place),
      this.#whole(out_index, place),
      this.numbers[out_value[0] + place],
      this.numbers[out_other[0] + place],
    ]);
  }
}
