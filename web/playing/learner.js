/** MIDI learn: detects which source somebody moves, so that it can be bound. */

import facts from "../facts.js";
import * as sources from "./sources.js";

const { DISTANCE, AT_REST } = facts.learner;
const { RESERVED, NO_NRPN, DATA_ENTRY } = facts.sources;
const [NRPN, NRPN_FINE] = facts.sources.NRPN;
const [RPN, RPN_FINE] = facts.sources.RPN;
/** @type {ReadonlyMap<string, number>} */
const REST = new Map(Object.entries(AT_REST));

// The kinds of channel messages: their status without the channel.
const POLY_TOUCH = 0xa0;
const CONTROL_CHANGE = 0xb0;
const PROGRAM_CHANGE = 0xc0;
const AFTERTOUCH = 0xd0;
const PITCH_WHEEL = 0xe0;

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
    const [status, first, second] = Array.from(bytes);
    const channel = sources.CHANNELS * port + (status & 0x0f);
    switch (kindOf(bytes)) {
      case PITCH_WHEEL:
        return this.#moved(channel, sources.BEND, (first | (second << 7)) / sources.FINEST);
      case AFTERTOUCH:
        return this.#moved(channel, sources.PRESSURE, first / sources.STEPS);
      case POLY_TOUCH:
        return this.#moved(channel, sources.POLY_PRESSURE, second / sources.STEPS);
      case CONTROL_CHANGE:
        return this.#control(channel, first, second);
      default:
        return null;
    }
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
 * The kind of a channel message; null for any other message, and for bytes that are none.
 * @param {ArrayLike<number>} bytes
 */
function kindOf({ length, 0: status, 1: first, 2: second }) {
  const kind = status & 0xf0;
  const isShort = kind === PROGRAM_CHANGE || kind === AFTERTOUCH;
  const isWhole = length === (isShort ? 2 : 3) && first < 0x80 && (isShort || second < 0x80);
  return status >= 0x80 && status < 0xf0 && isWhole ? kind : null;
}
