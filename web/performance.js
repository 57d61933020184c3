/** Keeps what was played as a file, and plays such a file again. */

/** @typedef {import('./instrument.js').Instrument} Instrument */
/** @typedef {import('./instrument.js').Wish} Wish */

import facts from "./facts.js";
import { TABLE, find } from "./playing/table.js";

const FORMAT = "yehu performance";
const VERSION = 1;
const MOST_BYTES = 64 << 20;
const EVERY = 60; // ms
const NAMES = Object.keys(facts.kinds).map((name) => name.toLowerCase());
const SETTINGS = new Set([facts.kinds.WRITE, facts.kinds.HOLD, facts.kinds.EXPRESS]);

/** Listens to the wishes of the player, and writes them down. */
export class Keeper {
  /** @param {Instrument} instrument */
  constructor(instrument) {
    this.instrument = instrument;
    /** @type {string[]} */
    this.lines = [];
    this.begun = 0;
    this.isOn = false;
    instrument.addEventListener("wish", (event) => {
      if (this.isOn) this.#keep(/** @type {CustomEvent<Wish>} */ (event).detail);
    });
  }

  start() {
    const { player, sound, frame } = this.instrument;
    const values = TABLE.filter(({ owned }) => !owned).map(({ address }) => [
      address,
      player.value(address),
    ]);
    this.lines = [
      JSON.stringify({
        format: FORMAT,
        version: VERSION,
        rate: sound?.status.rate,
        values: Object.fromEntries(values),
      }),
    ];
    this.begun = frame;
    this.isOn = true;
  }

  /** @param {Wish} wish */
  #keep({ frame, kind, index, value, other }) {
    const place = SETTINGS.has(kind) ? TABLE[index].address : index;
    const at = Math.max(frame - this.begun, 0);
    this.lines.push(JSON.stringify([at, NAMES[kind], place, value, other]));
  }

  /** End, and return the file. */
  stop() {
    this.isOn = false;
    return new Blob([this.lines.join("\n"), "\n"], { type: "application/jsonl" });
  }
}

/**
 * @typedef {object} Performance
 * @property {number} rate Hz
 * @property {Record<string, number>} values of parameters, at its beginning
 * @property {Wish[]} wishes by frame
 */

/**
 * Read a file of a performance; throws an error where it is none.
 * @param {Blob} file
 * @returns {Promise<Performance>}
 */
export async function readPerformance(file) {
  if (file.size > MOST_BYTES) throw new RangeError("too large");
  const [head, ...lines] = (await file.text()).split("\n").filter((line) => line !== "");
  const { format, version, rate, values } = JSON.parse(head);
  if (format !== FORMAT || version !== VERSION || !(rate >= 8000 && rate <= 384000)) {
    throw new TypeError("another format");
  }
  for (const [address, value] of Object.entries(values)) {
    find(address);
    finite(value);
  }
  const wishes = lines.map((line) => wishOf(JSON.parse(line)));
  return { rate, values, wishes: wishes.sort((one, other) => one.frame - other.frame) };
}

/**
 * @param {unknown[]} line
 * @returns {Wish}
 */
function wishOf([frame, name, place, value, other]) {
  const kind = NAMES.indexOf(String(name));
  if (kind < 0) throw new TypeError(`no ${name}`);
  const index = SETTINGS.has(kind) ? find(String(place)).row : finite(place);
  return { frame: finite(frame), kind, index, value: finite(value), other: finite(other) };
}

/** @param {unknown} value */
function finite(value) {
  if (typeof value !== "number" || !Number.isFinite(value)) throw new TypeError(`${value}`);
  return value;
}

/** Plays a performance; tells by the event 'end'. */
export class Replayer extends EventTarget {
  /**
   * @param {Instrument} instrument
   * @param {Performance} performance
   */
  constructor(instrument, { rate, values, wishes }) {
    super();
    this.instrument = instrument;
    this.wishes = wishes;
    this.next = 0;
    const own = instrument.sound?.status.rate ?? rate;
    this.ratio = own / rate;
    for (const [address, value] of Object.entries(values)) instrument.player.write(address, value);
    this.begun = instrument.horizon;
    this.latest = 0; // frame of the last wish that was posted
    this.timer = window.setInterval(() => this.#play(), EVERY);
  }

  #play() {
    for (; this.next < this.wishes.length; this.next++) {
      const { frame, kind, index, value, other } = this.wishes[this.next];
      const at = Math.round(this.begun + frame * this.ratio);
      if (at > this.instrument.horizon) return;
      this.instrument.post(at, kind, index, value, other);
      this.latest = at;
    }
    if (this.instrument.frame > this.latest) this.#end();
  }

  /** End it early. */
  stop() {
    // After all that was posted already: a note among it would never end.
    this.instrument.player.panic(Math.max(this.latest, this.instrument.frame));
    this.#end();
  }

  #end() {
    clearInterval(this.timer);
    this.dispatchEvent(new Event("end"));
  }
}
