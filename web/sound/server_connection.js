/** The connection to the server: a WebSocket that is opened again whenever it breaks. */

import facts from "../facts.js";
import { find } from "../playing/table.js";
import { COMMAND } from "./kernel.js";

const AGAIN_MS = 500;
const AGAIN_AT_MOST_MS = 5000;
const SNAPSHOT = 0; // what the first number of a message says
const COMMANDS = 1;
const MAX_UNSENT = 1 << 16; // bytes
const FIRST_PART = "1";
const NO_PIN = 4401; // close codes: the server wants a PIN, or another one
const NO_PART = 4404; // the server has no such part

/**
 * What the server sends once a second.
 * @typedef {object} ServerStatus
 * @property {number} page this page's number
 * @property {number} pages that are connected
 * @property {'listen' | 'play' | 'own'} role what this page may do
 * @property {number} part that this page plays, from 1
 * @property {number} parts of the server
 * @property {number} rate Hz
 * @property {number} frame that is played now
 * @property {number} load share of the time that computing takes
 * @property {number} dropouts
 * @property {string | null} [device] that plays; null: none does
 * @property {number} latencyMs
 * @property {'preparing' | 'ready' | 'none'} sounds whether pages can sound themselves
 */

/** @type {ServerStatus} */
const UNKNOWN = {
  page: -1,
  pages: 0,
  role: "own",
  part: 1,
  parts: 1,
  rate: 48000,
  frame: 0,
  load: 0,
  dropouts: 0,
  latencyMs: 0,
  sounds: "preparing",
};

/** The address of a WebSocket beside the page. @param {string} name */
export function socketUrl(name) {
  const url = new URL(`../${name}`, import.meta.url);
  url.protocol = url.protocol.replace("http", "ws");
  const pin = new URLSearchParams(location.search).get("pin");
  if (pin !== null) url.searchParams.set("pin", pin);
  return url.href;
}

/**
 * Events: 'open', 'break', 'status', 'snapshot' (detail: the numbers), 'commands' of another
 * page (detail: {page, commands}), 'refuse' where a PIN is missing or wrong, and 'left' (detail: the number of a page that went).
 */
export class ServerConnection extends EventTarget {
  constructor() {
    super();
    this.status = { ...UNKNOWN };
    this.heardAt = 0; // ms, of the last status
    this.isOpen = false;
    this.wanted = { snapshots: true, sounds: false }; // what is set is shown before anything sounds
    /** The latest snapshot, while snapshots come. @type {Float64Array | null} */
    this.seen = null;
    this.wait = AGAIN_MS;
    this.part = new URLSearchParams(location.search).get("part") ?? FIRST_PART;
    /** @type {WebSocket | null} */
    this.socket = null;
    /** Applied by the first status. @type {Promise<void>} */
    this.ready = new Promise((resolve) =>
      this.addEventListener("status", () => resolve(), { once: true }),
    );
    document.addEventListener("visibilitychange", () => this.#ask());
    this.#open();
  }

  /** Number of the sample that the server plays now, about. */
  get frame() {
    const { frame, rate } = this.status;
    return frame + ((performance.now() - this.heardAt) / 1e3) * rate;
  }

  /**
   * The value that was set last, by anybody, of a parameter that is not of bow and fingers.
   * @param {string} address
   */
  wasSet(address) {
    return this.seen?.[facts.snapshotLength + facts.parameters.length + find(address).index];
  }

  /** Fulfilled with the first snapshot. @returns {Promise<void>} */
  get first() {
    if (this.seen) return Promise.resolve();
    return new Promise((resolve) =>
      this.addEventListener("snapshot", () => resolve(), { once: true }),
    );
  }

  /**
   * What this page wants to get: snapshots of the server's instrument, and other pages' commands.
   * @param {{snapshots: boolean, sounds: boolean}} wanted
   */
  want(wanted) {
    this.wanted = wanted;
    this.#ask();
  }

  /**
   * Send commands: five numbers each. Nothing is kept for later: a note would come too late.
   * @param {Float64Array<ArrayBuffer>} commands
   */
  send(commands) {
    if (this.isOpen && this.socket && this.socket.bufferedAmount < MAX_UNSENT) {
      this.socket.send(commands);
    }
  }

  #ask() {
    if (!this.isOpen) return;
    const { snapshots, sounds } = this.wanted;
    this.socket?.send(JSON.stringify({ snapshots: snapshots && !document.hidden, sounds }));
  }

  #open() {
    const url = new URL(socketUrl("socket"));
    url.searchParams.set("part", this.part);
    const socket = new WebSocket(url);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.isOpen = true;
      this.wait = AGAIN_MS;
      this.#ask();
      this.dispatchEvent(new Event("open"));
    };
    socket.onmessage = ({ data }) => {
      if (typeof data === "string") this.#hear(JSON.parse(data));
      else this.#read(new Float64Array(data));
    };
    socket.onclose = ({ code }) => {
      if (code === NO_PART) this.part = FIRST_PART;
      const wasOpen = this.isOpen;
      this.isOpen = false;
      this.seen = null;
      if (wasOpen) this.dispatchEvent(new Event("break"));
      if (code === NO_PIN) {
        this.dispatchEvent(new Event("refuse"));
        return; // to ask again with the same PIN is of no use
      }
      setTimeout(() => this.#open(), this.wait);
      this.wait = Math.min(2 * this.wait, AGAIN_AT_MOST_MS);
    };
    this.socket = socket;
  }

  /** @param {{status?: ServerStatus, left?: number}} message */
  #hear({ status, left }) {
    if (status) {
      this.status = { ...UNKNOWN, ...status };
      this.heardAt = performance.now();
      this.dispatchEvent(new Event("status"));
    }
    if (left !== undefined) this.dispatchEvent(new CustomEvent("left", { detail: left }));
  }

  /** @param {Float64Array} numbers */
  #read(numbers) {
    const [what, page] = numbers;
    if (what === SNAPSHOT) {
      this.seen = numbers.subarray(1);
      this.dispatchEvent(new CustomEvent("snapshot", { detail: this.seen }));
    } else if (what === COMMANDS) {
      const commands = [];
      for (let i = 2; i < numbers.length; i += COMMAND)
        commands.push(numbers.subarray(i, i + COMMAND));
      this.dispatchEvent(new CustomEvent("commands", { detail: { page, commands } }));
    }
  }
}
