/** Plays a tune's MIDI messages in time; or follows somebody who plays its notes, and waits or keeps time. */

/** @typedef {import('./instrument.js').Instrument} Instrument */
/** @typedef {import('./hands/fingering.js').Note} Note */

import facts from "./facts.js";
import { fingered, habitsOf, notesOf } from "./hands/fingering.js";
import { MAPPINGS } from "./playing/learned.js";

/**
 * @typedef {object} Tune As `examples.js` has it.
 * @property {string} name
 * @property {string} mapping
 * @property {boolean} isEasy
 * @property {number} seconds
 * @property {number} tonic the note that is do
 * @property {[number, number[]][]} events seconds, and the bytes of a message
 */

const PORT = 15; // away from the keyboards' ports
const EVERY = 60; // ms
const RIGHT_WITHIN = 0.5; // semitones
const IN_TIME = 0.4; // s before or after its time
const COUNT_IN = 2; // s before the first note

/** A tune that is on. Events: 'move' as it goes on, and 'end'. */
class Course extends EventTarget {
  /** @type {ReturnType<typeof habitsOf> | null} */
  #habits = null;
  /** @type {import('./hands/fingering.js').Fingered[]} */
  #fingering = [];

  /**
   * @param {Instrument} instrument
   * @param {Tune} tune
   * @param {number} pace 1: as it was written
   */
  constructor(instrument, tune, pace) {
    super();
    this.instrument = instrument;
    this.tune = tune;
    this.pace = pace;
    this.notes = notesOf(tune);
    this.at = 0; // the next note
    /** Whether notes were right at once; of one that listens there is nothing. @type {boolean[]} */
    this.marks = [];
    this.isTimed = true; // it goes on by itself
    this.timer = 0;
  }

  get isOn() {
    return this.timer !== 0;
  }

  /** Seconds of the tune that have gone. */
  get now() {
    return 0;
  }

  /** Share of the tune that has gone. */
  get progress() {
    return Math.min(Math.max(this.now / this.tune.seconds, 0), 1);
  }

  /** What the player does with the notes, as it plays now. */
  get fingering() {
    const habits = habitsOf(this.instrument.player);
    const { shakes, string, own } = this.#habits ?? {};
    if (habits.shakes !== shakes || habits.string !== string || habits.own !== own)
      [this.#habits, this.#fingering] = [habits, fingered(this.notes, habits, this.pace)];
    return this.#fingering;
  }

  move() {
    this.dispatchEvent(new Event("move"));
  }

  end() {
    clearInterval(this.timer);
    this.timer = 0;
    this.dispatchEvent(new Event("end"));
  }
}

export class TunePlayer extends Course {
  #next = 0;
  #begun = 0; // frame
  #latest = 0; // frame of the last message that was given to the player

  get now() {
    return ((this.instrument.frame - this.#begun) / this.#rate) * this.pace;
  }

  /** Begin; the sound has to be open. */
  start() {
    this.instrument.player.remap(MAPPINGS[this.tune.mapping]);
    this.#begun = this.instrument.horizon;
    this.timer = window.setInterval(() => this.#play(), EVERY);
    this.move();
  }

  get #rate() {
    return this.instrument.sound?.status.rate ?? 1;
  }

  #play() {
    const { events } = this.tune;
    for (; this.#next < events.length; this.#next++) {
      const [seconds, bytes] = events[this.#next];
      const frame = Math.round(this.#begun + (seconds / this.pace) * this.#rate);
      if (frame > this.instrument.horizon) break;
      this.instrument.player.midi(bytes, frame, PORT);
      this.#latest = frame;
    }
    while (this.at < this.notes.length && this.notes[this.at].at <= this.now) this.at++;
    this.move();
    if (this.progress >= 1) this.stop();
  }

  stop() {
    if (!this.isOn) return;
    // What the player has already is played; it ends after that.
    const { player, frame, mapping } = this.instrument;
    const last = Math.max(this.#latest, frame);
    player.endPortNotes(PORT, last);
    player.remap(mapping, last);
    this.end();
  }
}

/** Follows whoever plays a tune. Events: also 'wrong' of a note that is another (as `pitch`). */
export class TuneGuide extends Course {
  #begun = 0; // ms
  #tries = 0; // wrong ones of the next note
  #wrongs = new Map(); // how often each note was missed
  #offsets = /** @type {number[]} */ ([]); // s, of notes that were in time
  #sounding = NaN;
  #direction = 0;
  /** What was played last and was wrong. */
  pitch = NaN;

  /**
   * @param {Instrument} instrument
   * @param {Tune} tune
   * @param {number} pace
   * @param {boolean} isTimed it keeps time, else it waits for each note
   */
  constructor(instrument, tune, pace, isTimed) {
    super(instrument, tune, pace);
    this.isTimed = isTimed;
  }

  get now() {
    if (!this.isTimed) return (this.notes[this.at] ?? { at: this.tune.seconds }).at;
    const seconds = (performance.now() - this.#begun) / 1000;
    return this.#begun ? (seconds - COUNT_IN) * this.pace : -COUNT_IN;
  }

  start() {
    this.#begun = performance.now();
    this.instrument.addEventListener("command", this.#hear);
    this.timer = window.setInterval(() => this.#tick(), EVERY);
    this.move();
  }

  stop() {
    if (!this.isOn) return;
    this.instrument.removeEventListener("command", this.#hear);
    this.end();
  }

  #tick() {
    if (!this.isTimed) return;
    const gone = this.now - IN_TIME * this.pace;
    while (this.at < this.notes.length && this.notes[this.at].at < gone) this.#pass(false);
    this.move();
    this.#stopAtEnd();
  }

  #hear = (/** @type {Event} */ event) => {
    const { kind, value, other } = /** @type {CustomEvent} */ (event).detail;
    if (kind === facts.kinds.BEGIN) {
      this.#sounding = other;
      if (!this.#play(other)) this.#miss(other);
    } else if (kind === facts.kinds.SLIDE) {
      this.#sounding = value;
      if (!this.#isRepeated) this.#play(value);
    } else if (kind === facts.kinds.DRAW && value !== 0) {
      const isTurned = Math.sign(value) === -this.#direction;
      this.#direction = Math.sign(value);
      if (isTurned && this.#isRepeated) this.#play(this.#sounding); // by another stroke of the hand
    }
  };

  /** Whether the next note is the one before once more: it has to be begun again. */
  get #isRepeated() {
    return this.notes[this.at]?.pitch === this.notes[this.at - 1]?.pitch;
  }

  /** Number of notes of the same pitch that come now. */
  get repeats() {
    const same = this.notes
      .slice(this.at)
      .findIndex(({ pitch }) => pitch !== this.notes[this.at].pitch);
    return same < 0 ? this.notes.length - this.at : same;
  }

  /**
   * Take a note for the one that is asked for.
   * @param {number} pitch
   * @returns {boolean} whether it is
   */
  #play(pitch) {
    const reach = this.isTimed ? IN_TIME * this.pace : 0;
    const found = this.notes.findIndex(
      (note, i) =>
        i >= this.at &&
        Math.abs(note.at - this.now) <= reach &&
        Math.abs(note.pitch - pitch) <= RIGHT_WITHIN,
    );
    if (found < 0) return false;
    while (this.at < found) this.#pass(false);
    this.#offsets.push((this.now - this.notes[found].at) / this.pace);
    this.#pass(this.isTimed || this.#tries === 0);
    this.move();
    if (!this.isTimed) this.#stopAtEnd();
    return true;
  }

  /** @param {number} pitch */
  #miss(pitch) {
    const next = this.notes[this.at];
    if (!next || (this.isTimed && this.now < -IN_TIME)) return;
    this.#tries += 1;
    this.pitch = pitch;
    this.dispatchEvent(new Event("wrong"));
  }

  /** @param {boolean} isRight */
  #pass(isRight) {
    if (!isRight)
      this.#wrongs.set(this.at, (this.#wrongs.get(this.at) ?? 0) + Math.max(this.#tries, 1));
    this.marks[this.at] = isRight;
    this.at += 1;
    this.#tries = 0;
  }

  #stopAtEnd() {
    if (this.at >= this.notes.length && this.progress >= 1) this.stop();
  }

  /**
   * The result; null where it was ended early.
   * @returns {{right: number, count: number, run: number, late: number, hardest: Note[] | null} | null}
   */
  get result() {
    const count = this.notes.length;
    if (this.at < count) return null;
    let [run, longest] = [0, 0];
    for (const isRight of this.marks) longest = Math.max(longest, (run = isRight ? run + 1 : 0));
    const [[hardest] = [-1]] = [...this.#wrongs].sort(([, one], [, other]) => other - one);
    const sum = this.#offsets.reduce((all, one) => all + one, 0);
    return {
      right: this.marks.filter(Boolean).length,
      count,
      run: longest,
      late: this.#offsets.length ? sum / this.#offsets.length : 0,
      hardest: hardest > 0 ? [this.notes[hardest - 1], this.notes[hardest]] : null,
    };
  }
}
