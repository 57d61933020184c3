/** Sends the commands of a page that computes its own sound to the server and to other such pages, and plays theirs. */

/** @typedef {import('../instrument.js').Instrument} Instrument */
/** @typedef {import('../instrument.js').Command} Command */
/** @typedef {import('./server_connection.js').ServerConnection} ServerConnection */

import facts from "../facts.js";
import { NOW, CommandBatch } from "./kernel.js";

const { BEGIN, END } = facts.kinds;
// Channels of another page's keys, as the server distinguishes visitors.
const FIRST = 1 << 16;
const CHANNELS = 1 << 12;

export class Sharing {
  /** @param {Instrument} instrument @param {ServerConnection} connection */
  constructor(instrument, connection) {
    this.instrument = instrument;
    this.connection = connection;
    this.batch = new CommandBatch((commands) => connection.send(commands));
    /** Keys that other pages hold: pairs of channel and key. @type {Map<number, number[][]>} */
    this.held = new Map();
    this.own = (/** @type {Event} */ event) =>
      this.#share(/** @type {CustomEvent<Command>} */ (event).detail);
    this.others = (/** @type {Event} */ event) => {
      const { page, commands } = /** @type {CustomEvent} */ (event).detail;
      for (const command of commands) this.#play(page, command);
    };
    this.left = (/** @type {Event} */ event) =>
      this.#releaseKeys(/** @type {CustomEvent<number>} */ (event).detail);
    this.broken = () => {
      for (const page of [...this.held.keys()]) this.#releaseKeys(page);
    };
    instrument.addEventListener("command", this.own);
    connection.addEventListener("commands", this.others);
    connection.addEventListener("left", this.left);
    connection.addEventListener("break", this.broken);
    connection.want({ snapshots: true, sounds: true }); // they have what others set
  }

  /** @param {Command} command */
  #share({ frame, kind, index, value, other }) {
    const { sound, frame: here } = this.instrument;
    const ahead = (frame - here) / (sound?.status.rate ?? 1);
    const there = Math.round(this.connection.frame + ahead * this.connection.status.rate);
    this.batch.post(ahead > 0 ? Math.max(there, 0) : null, kind, index, value, other);
  }

  /** @param {number} page @param {Float64Array} command */
  #play(page, [frame, kind, index, value, other]) {
    const { sound } = this.instrument;
    if (!sound) return;
    const ahead = frame === NOW ? 0 : (frame - this.connection.frame) / this.connection.status.rate;
    const at = ahead > 0 ? Math.round(this.instrument.frame + ahead * sound.status.rate) : null;
    const isKey = kind === BEGIN || kind === END;
    const channel = FIRST + page * CHANNELS + CHANNELS / 2 + index;
    if (isKey) this.#remember(page, kind, channel, value);
    sound.post(at, kind, isKey ? channel : index, value, other);
  }

  /**
   * @param {number} page
   * @param {number} kind
   * @param {number} channel
   * @param {number} key
   */
  #remember(page, kind, channel, key) {
    const held = (this.held.get(page) ?? []).filter(
      ([ofChannel, ofKey]) => ofChannel !== channel || ofKey !== key,
    );
    if (kind === BEGIN) held.push([channel, key]);
    this.held.set(page, held);
  }

  /** End what a page held that is gone. @param {number} page */
  #releaseKeys(page) {
    for (const [channel, key] of this.held.get(page) ?? []) {
      this.instrument.sound?.post(null, END, channel, key, 0);
    }
    this.held.delete(page);
  }

  close() {
    this.broken();
    this.instrument.removeEventListener("command", this.own);
    this.connection.removeEventListener("commands", this.others);
    this.connection.removeEventListener("left", this.left);
    this.connection.removeEventListener("break", this.broken);
    this.connection.want({ snapshots: false, sounds: false });
  }
}
