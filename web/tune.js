/** Plays a tune's MIDI messages in time, or waits for somebody who plays its notes. */

/** @typedef {import('./instrument.js').Instrument} Instrument */

import facts from "./facts.js";
import { MAPPINGS } from "./playing/learned.js";
import { transposed } from "./playing/range.js";

/**
 * @typedef {object} Tune As `examples.js` has it.
 * @property {string} name
 * @property {string} mapping
 * @property {number} seconds
 * @property {[number, number[]][]} events seconds, and the bytes of a message
 */

const PORT = 15; // away from the keyboards' ports
const EVERY = 60; // ms
const NOTE_ON = 0x90;
const PERCUSSION = 9;
const RIGHT_WITHIN = 0.5; // semitones

/** Tells by events: 'move' as it goes on, and 'end'. */
export class TunePlayer extends EventTarget {
  /**
   * @param {Instrument} instrument
   * @param {Tune} tune
   */
  constructor(instrument, tune) {
    super();
    this.instrument = instrument;
    this.tune = tune;
    this.next = 0;
    this.begun = 0; // frame
    this.latest = 0; // frame of the last message that was given to the player
    this.timer = 0;
  }

  /** Share of the tune that was played. */
  get progress() {
    const rate = this.instrument.sound?.status.rate ?? 1;
    return Math.min(
      Math.max((this.instrument.frame - this.begun) / rate / this.tune.seconds, 0),
      1,
    );
  }

  /** Begin; the sound has to be open. */
  start() {
    this.instrument.player.remap(MAPPINGS[this.tune.mapping]);
    this.begun = this.instrument.horizon;
    this.timer = window.setInterval(() => this.#play(), EVERY);
  }

  get #rate() {
    return this.instrument.sound?.status.rate ?? 1;
  }

  #play() {
    const { events } = this.tune;
    for (; this.next < events.length; this.next++) {
      const [seconds, bytes] = events[this.next];
      const frame = Math.round(this.begun + seconds * this.#rate);
      if (frame > this.instrument.horizon) break;
      this.instrument.player.midi(bytes, frame, PORT);
      this.latest = frame;
    }
    this.dispatchEvent(new Event("move"));
    if (this.progress >= 1) this.stop();
  }

  stop() {
    if (!this.timer) return;
    clearInterval(this.timer);
    this.timer = 0;
    // What the player has already is played; it ends after that.
    const { player, frame } = this.instrument;
    player.endPortNotes(PORT, Math.max(this.latest, frame));
    player.remap(this.instrument.mapping, Math.max(this.latest, frame));
    this.dispatchEvent(new Event("end"));
  }
}

/** Shows a tune's notes one by one, and goes on when each was played. */
export class TuneGuide extends EventTarget {
  /**
   * @param {Instrument} instrument
   * @param {Tune} tune
   */
  constructor(instrument, tune) {
    super();
    this.instrument = instrument;
    this.notes = notesOf(tune);
    this.at = 0;
    this.hear = (/** @type {Event} */ event) => {
      const { kind, value, other } = /** @type {CustomEvent} */ (event).detail;
      if (kind === facts.kinds.BEGIN) this.#played(other);
      else if (kind === facts.kinds.SLIDE) this.#played(value);
    };
  }

  get progress() {
    return this.at / this.notes.length;
  }

  /** The note to be played next; null at the end. */
  get next() {
    return this.notes[this.at] ?? null;
  }

  start() {
    this.instrument.addEventListener("wish", this.hear);
    this.dispatchEvent(new Event("move"));
  }

  /** @param {number} pitch */
  #played(pitch) {
    if (this.next === null || Math.abs(pitch - this.next) > RIGHT_WITHIN) return;
    this.at++;
    this.dispatchEvent(new Event("move"));
    if (this.next === null) this.stop();
  }

  stop() {
    this.instrument.removeEventListener("wish", this.hear);
    this.dispatchEvent(new Event("end"));
  }
}

/**
 * The pitches of a tune's notes, in order, within the instrument's range.
 * @param {Tune} tune
 */
function notesOf(tune) {
  const notes = [];
  for (const [, [status, key, velocity]] of tune.events) {
    const isNote = (status & 0xf0) === NOTE_ON && velocity > 0 && (status & 0x0f) !== PERCUSSION;
    if (isNote) notes.push(transposed(key));
  }
  return notes;
}
