/** The line to the server: a WebSocket that is opened again whenever it breaks. */

import { WISH } from "./kernel.js";

const AGAIN_MS = 500;
const AGAIN_AT_MOST_MS = 5000;
const LOOK = 0; // what the first number of a message says
const WISHES = 1;
const MOST_UNSENT = 1 << 16; // bytes
const FIRST_PART = "1";
const NO_PART = 4404; // close code: the server has no such part

/**
 * What the server tells once a second.
 * @typedef {object} ServerStatus
 * @property {number} page this page's number
 * @property {number} pages that are connected
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
  part: 1,
  parts: 1,
  rate: 48000,
  frame: 0,
  load: 0,
  dropouts: 0,
  latencyMs: 0,
  sounds: "preparing",
};

/** Whether this page was served by a server that plays. */
export function hasServer() {
  return document.querySelector('meta[name="yehu-server"]') !== null;
}

/**
 * The address of a WebSocket beside the page.
 * @param {string} name
 */
export function socketUrl(name) {
  const url = new URL(`../${name}`, import.meta.url);
  url.protocol = url.protocol.replace("http", "ws");
  return url.href;
}

/**
 * Tells by events: 'open', 'break', 'status', 'look' (detail: the numbers), 'wishes' of another
 * page (detail: {page, wishes}), and 'left' (detail: the number of a page that went).
 */
export class ServerConnection extends EventTarget {
  constructor() {
    super();
    this.status = { ...UNKNOWN };
    this.heardAt = 0; // ms, of the last status
    this.isOpen = false;
    this.wanted = { looks: false, sounds: false };
    this.wait = AGAIN_MS;
    this.part = new URLSearchParams(location.search).get("part") ?? FIRST_PART;
    /** @type {WebSocket | null} */
    this.socket = null;
    /** Fulfilled by the first status. @type {Promise<void>} */
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
   * What this page wants to get: looks at the server's instrument, and other pages' wishes.
   * @param {{looks: boolean, sounds: boolean}} wanted
   */
  want(wanted) {
    this.wanted = wanted;
    this.#ask();
  }

  /**
   * Send wishes: five numbers each. Nothing is kept for later: a note would come too late.
   * @param {Float64Array<ArrayBuffer>} wishes
   */
  send(wishes) {
    if (this.isOpen && this.socket && this.socket.bufferedAmount < MOST_UNSENT) {
      this.socket.send(wishes);
    }
  }

  #ask() {
    if (!this.isOpen) return;
    const { looks, sounds } = this.wanted;
    this.socket?.send(JSON.stringify({ looks: looks && !document.hidden, sounds }));
  }

  #open() {
    const socket = new WebSocket(`${socketUrl("socket")}?part=${encodeURIComponent(this.part)}`);
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
      if (wasOpen) this.dispatchEvent(new Event("break"));
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
    if (what === LOOK) {
      this.dispatchEvent(new CustomEvent("look", { detail: numbers.subarray(1) }));
    } else if (what === WISHES) {
      const wishes = [];
      for (let i = 2; i < numbers.length; i += WISH) wishes.push(numbers.subarray(i, i + WISH));
      this.dispatchEvent(new CustomEvent("wishes", { detail: { page, wishes } }));
    }
  }
}
