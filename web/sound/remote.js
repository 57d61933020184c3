/**
 * The instrument of the server, for the page: posts commands to it, and reports what it does; the page
 * may also hear it. It has the same interface as `Sound`.
 */

import facts from "../facts.js";
import { find } from "../playing/table.js";
import { StreamPlayer } from "./stream_player.js";
import { snapshotOf, targetOf } from "./snapshot.js";
import { CommandBatch } from "./kernel.js";

/** @typedef {import('./server_connection.js').ServerConnection} ServerConnection */
/** @typedef {import('../interfaces.js').Status} Status */

/** Event: 'state' of a new snapshot. */
export class Remote extends EventTarget {
  /**
   * @param {ServerConnection} connection to the server
   * @param {boolean} listens whether the page hears the server; only after a touch
   * @returns {Promise<Remote>}
   */
  static async open(connection, listens) {
    const opening = listens ? StreamPlayer.open(connection.status.rate) : null; // while the touch counts
    await connection.ready;
    return new Remote(connection, await opening);
  }

  /** @param {ServerConnection} connection @param {StreamPlayer | null} listener */
  constructor(connection, listener) {
    super();
    this.connection = connection;
    this.listener = listener;
    this.seen = new Float64Array(facts.snapshotLength + 2 * facts.parameters.length);
    this.isSeen = false;
    this.maxPlayers = Infinity; // the server limits them
    this.state = snapshotOf(this.seen);
    this.analyser = listener?.analyser ?? null;
    this.post = new CommandBatch((commands) => connection.send(commands)).post;
    this.onSnapshot = (/** @type {Event} */ event) => {
      this.seen.set(/** @type {CustomEvent<Float64Array>} */ (event).detail);
      this.isSeen = true;
      this.state = snapshotOf(this.seen);
      this.dispatchEvent(new Event("state"));
    };
    connection.addEventListener("snapshot", this.onSnapshot);
    connection.want({ snapshots: true, sounds: false });
  }

  get frame() {
    return Math.round(this.connection.frame);
  }

  /** @param {string} address of a parameter of bow or fingers */
  target(address) {
    return targetOf(this.seen, address);
  }

  /** The value of any other parameter, whoever set it. @param {string} address */
  reported(address) {
    const { index, playerControlled } = find(address);
    return playerControlled || !this.isSeen ? undefined : this.seen[facts.snapshotLength + index];
  }

  /** @returns {Status} */
  get status() {
    const { rate, load, dropouts, latencyMs } = this.connection.status;
    const heard = this.listener?.status;
    return {
      backend: this.listener ? "listening" : "remote",
      rate,
      loadPercent: 100 * load,
      latencyMs: latencyMs + (heard?.latencyMs ?? 0),
      dropouts: dropouts + (heard?.dropouts ?? 0),
      running: this.connection.isOpen && (heard?.running ?? true),
    };
  }

  /** Go on after the browser has suspended the sound. */
  resume() {
    return this.listener?.resume();
  }

  close() {
    this.connection.removeEventListener("snapshot", this.onSnapshot);
    this.connection.want({ snapshots: false, sounds: false });
    this.listener?.close();
  }
}
