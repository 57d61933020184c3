/** MIDI learn: detects which source somebody moves, so that it can be bound. */

import facts from "../facts.js";
import * as sources from "./sources.js";

const { DISTANCE, AT_REST } = facts.learner;
const { RESERVED, NO_NRPN, DATA_ENTRY } = facts.sources;
const [NRPN, NRPN_FINE] = facts.sources.NRPN;
const [RPN, RPN_FINE] = facts.sources.RPN;
/** @type {ReadonlyMap<string, number>} */
const REST = new Map(Object.entries(AT_REST));

const NOTE_OFF = 0x80;
const NOTE_ON = 0x90;
const POLY_TOUCH = 0xa0;
const CONTROL_CHANGE = 0xb0;
const PROGRAM_CHANGE = 0xc0;
const AFTERTOUCH = 0xd0;
const PITCH_WHEEL = 0xe0;
const SYSTEM = 0xf0;
const SYSTEM_RESET = 0xff;

/**
 * @typedef {object} Channel The control changes received on one channel.
 * @property {number | null} before the control change before
 * @property {[number | null, number | null]} nrpn the halves of the number selected
 */

/** Compares each source with where it began, until one has moved far enough to be meant. */
export class Learner {
  /** @type {Map<string, number>} by channel and source */
  #beganAt = new Map();
  /** @type {Map<number, Channel>} */
  #channels = new Map();
  /** Channels and coarse halves of which a fine half was heard. @type {Set<string>} */
  #pairs = new Set();

  /**
   * Receive a MIDI message; return the source, once one has moved far enough.
   * @param {ArrayLike<number>} bytes
   * @param {number} port
   * @returns {string | null}
   */
  hear(bytes, port = 0) {
    const kind = kindOf(bytes);
    if (kind === null || kind === SYSTEM_RESET) return null;
    const channel = sources.CHANNELS * port + (bytes[0] & 0x0f);
    const [, first, second] = Array.from(bytes);
    if (kind === PITCH_WHEEL) {
      return this.#moved(channel, sources.BEND, (first | (second << 7)) / sources.FINEST);
    }
    if (kind === AFTERTOUCH) {
      return this.#moved(channel, sources.PRESSURE, first / sources.STEPS);
    }
    if (kind === POLY_TOUCH) {
      return this.#moved(channel, sources.POLY_PRESSURE, second / sources.STEPS);
    }
    return kind === CONTROL_CHANGE ? this.#control(channel, first, second) : null;
  }

  /**
   * @param {number} channel
   * @param {number} control
   * @param {number} value
   * @returns {string | null}
   */
  #control(channel, control, value) {
    const state = this.#channels.get(channel) ?? { before: null, nrpn: [null, null] };
    this.#channels.set(channel, state);
    const { before } = state;
    state.before = control;
    if (control === NRPN) state.nrpn[0] = value;
    else if (control === NRPN_FINE) state.nrpn[1] = value;
    else if (control === RPN || control === RPN_FINE) state.nrpn = [null, null];
    else if (control === DATA_ENTRY && !state.nrpn.includes(null)) {
      const number = (Number(state.nrpn[0]) << 7) | Number(state.nrpn[1]);
      if (number < NO_NRPN)
        return this.#moved(channel, sources.nrpn(number), value / sources.STEPS);
    }
    if (RESERVED.includes(control)) return null;
    const coarse = control - sources.FINE_ABOVE;
    if (sources.isCoarse(coarse)) {
      if (before === coarse) this.#pairs.add(`${channel} ${coarse}`);
      if (this.#pairs.has(`${channel} ${coarse}`)) return null; // the fine half of a pair
    }
    const found = this.#moved(channel, sources.control(control), value / sources.STEPS);
    const isPair = this.#pairs.has(`${channel} ${control}`);
    return found !== null && isPair ? sources.pair(control) : found;
  }

  /**
   * @param {number} channel
   * @param {string} source
   * @param {number} position
   * @returns {string | null}
   */
  #moved(channel, source, position) {
    const key = `${channel} ${source}`;
    const began = this.#beganAt.get(key) ?? REST.get(source) ?? position;
    this.#beganAt.set(key, began);
    return Math.abs(position - began) >= DISTANCE ? source : null;
  }
}

/**
 * The kind of a message: the status of a channel message without its channel, or SYSTEM_RESET;
 * null for any other message, and for bytes that are none.
 * @param {ArrayLike<number>} bytes
 * @returns {number | null}
 */
function kindOf(bytes) {
  const status = bytes[0] ?? 0;
  if (status >= SYSTEM) return status === SYSTEM_RESET && bytes.length === 1 ? status : null;
  const kind = status & 0xf0;
  const length = kind === PROGRAM_CHANGE || kind === AFTERTOUCH ? 2 : 3;
  if (kind < NOTE_OFF || bytes.length !== length) return null;
  return bytes[1] < 0x80 && (length === 2 || bytes[2] < 0x80) ? kind : null;
}
