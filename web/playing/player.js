/** The player: all control of the instrument, by hands, MIDI and presets, goes through it. */

import facts from '../facts.js';
import { MAPPINGS } from './learned.js';
import { clamp } from './numbers.js';
import { ParameterError, TABLE, accept, find } from './table.js';
import { writeTables, writeTuning } from './tables.js';

const { WRITE, DRAW, LIFT, SLIDE, STOP, RELEASE } = facts.kinds;
const { MESSAGE, FINGER_ON, NOTE_OFF, SET, LOAD, DISCONNECT, RELEASE_ALL, TABLES_TO } = facts.events;
const { LOWEST_NOTE, HIGHEST_NOTE, ELSEWHERE } = facts.notes;
const HIGHEST_KEY = facts.notes.KEYS - 1;
const { CHANNELS } = facts.sources;
const MOST_BYTES = 3; // of a message
/** @type {Readonly<Record<string, Tuning>>} */
const TUNINGS = facts.tunings;
/** @type {Readonly<Record<string, {values: Readonly<Record<string, number>>}>>} */
const PRESETS = facts.presets.shipped;
const { row: SECTION } = find('/playing/section');
const [BOW_SPEED, BOW_FORCE, BOW_ASSIST] = ['/bow/speed', '/bow/force', '/bow/assist'].map(find);
// Within this time the sound has a write, and tells the value that it moves to.
const TOLD_WITHIN_S = 0.1;

/**
 * @typedef {import('./interpreter.js').Interpreter} Interpreter
 * @typedef {import('./learned.js').Mapping} Mapping
 * @typedef {import('./tables.js').Tuning} Tuning
 *
 * @typedef {object} Sink What wishes are posted to.
 * @property {(frame: number | null, kind: number, index: number, value: number, other: number)
 *   => unknown} post one wish; frame null is now
 * @property {number} [frame] number of the next sample, as far as the page knows
 * @property {number} [rate] Hz
 * @property {(address: string) => number | undefined} [target] where a parameter of bow and
 *   fingers moves to
 * @property {number} [people] how many may play it; by default one
 * @property {(address: string) => number | undefined} [told] the value of any other parameter, where
 *   others set them too
 *
 * @typedef {number | string} NoteId Tells notes that hands hold at one time apart.
 *
 * @typedef {object} Key
 * @property {number} channel
 * @property {number} note
 */

/**
 * Plays the instrument: each call is an event for the interpreter, which makes wishes of it at a
 * frame, or now. Before there is an interpreter calls do nothing, but for `panic`.
 *
 * Frames may lie ahead, as of a tune that is played; `endNotes` and `panic` come after all of them.
 */
export class Player {
  #sink;
  /** @type {Interpreter | null} */
  #interpreter = null;
  #mapping = MAPPINGS[facts.defaultMapping];
  /** @type {Tuning} */
  #tuning = TUNINGS.equal;
  #latest = 0; // the latest frame of any call
  #now = 0; // frame of the last event for now
  /** The keys that hands hold. @type {Map<NoteId, Key>} */
  #inHand = new Map();
  /** The last writes, by row. @type {Map<number, {value: number, frame: number}>} */
  #written = new Map();

  /** @param {Sink} sink */
  constructor(sink) {
    this.#sink = sink;
  }

  /**
   * Play by an interpreter that was sent nothing.
   * @param {Interpreter} interpreter
   */
  playBy(interpreter) {
    this.#interpreter = interpreter;
    this.remap(this.#mapping);
  }

  // -- frames ------------------------------------------------------------------------------

  get #frame() {
    return this.#sink.frame ?? 0;
  }

  /**
   * The frame itself; remembers the latest.
   * @param {number | null} frame
   * @returns {number | null}
   */
  #at(frame) {
    if (frame === null) return null;
    // A tune far ahead is no reason to wait for its end.
    if (this.#latest > frame + (this.#sink.rate ?? 0)) this.#latest = frame;
    this.#latest = Math.max(this.#latest, frame);
    return frame;
  }

  /**
   * A frame after which nothing is wished yet, or now.
   * @param {number | null} frame
   * @returns {number | null}
   */
  #afterAll(frame) {
    if (frame !== null) return Math.max(this.#at(frame) ?? frame, this.#latest);
    const now = this.#frame;
    if (this.#latest > now + (this.#sink.rate ?? 0)) this.#latest = now;
    return this.#latest > now ? this.#latest : null;
  }

  // -- events and wishes -------------------------------------------------------------------

  /**
   * Have an event interpreted, and post what it comes to.
   * @param {number | null} frame
   * @param {number} kind
   * @param {number} [index]
   * @param {number} [value]
   * @param {number} [other]
   */
  #take(frame, kind, index = 0, value = 0, other = 0) {
    const interpreter = this.#interpreter;
    if (interpreter === null) return;
    this.#learnValues(interpreter);
    // What is for now has a frame of its own, before all others.
    const wishes = interpreter.take(frame ?? --this.#now, kind, index, value, other);
    for (const [kind, index, value, other] of wishes) {
      const isSection = kind === WRITE && index === SECTION;
      this.#post(frame, kind, index, isSection ? this.#people(interpreter, value) : value, other);
    }
  }

  /**
   * Let the interpreter know what others have set.
   * @param {Interpreter} interpreter
   */
  #learnValues({ values }) {
    for (const { address, row, owned } of TABLE) {
      const told = owned || this.#isRecent(row) ? undefined : this.#sink.told?.(address);
      if (told !== undefined) values[row] = told;
    }
  }

  /**
   * How many shall play: the interpreter knows of one only.
   * @param {Interpreter} interpreter
   * @param {number} one
   */
  #people({ found, values }, one) {
    const { people = 1 } = this.#sink;
    return people > 1 ? (values[SECTION] = Math.min(Math.round(found[SECTION]), people)) : one;
  }

  /**
   * @param {number | null} frame
   * @param {number} kind
   * @param {number} index
   * @param {number} value
   * @param {number} other
   */
  #post(frame, kind, index, value, other) {
    if (kind === WRITE) this.#note(index, value, frame);
    if (kind === DRAW) {
      this.#note(BOW_SPEED.row, value, frame);
      this.#note(BOW_FORCE.row, other, frame);
    }
    // Raw newtons are heard only without assist.
    if (kind === DRAW || (kind === WRITE && index === BOW_FORCE.row)) {
      this.#note(BOW_ASSIST.row, 0, frame);
    }
    this.#sink.post(frame, kind, index, value, other);
  }

  /**
   * @param {number} row
   * @param {number} value
   * @param {number | null} frame
   */
  #note(row, value, frame) {
    this.#written.set(row, { value, frame: frame ?? this.#frame });
  }

  /**
   * Whether a parameter was written so lately that the sound may not tell it yet.
   * @param {number} row
   */
  #isRecent(row) {
    const written = this.#written.get(row);
    return (
      written !== undefined && this.#frame < written.frame + TOLD_WITHIN_S * (this.#sink.rate ?? 0)
    );
  }

  // -- parameters --------------------------------------------------------------------------

  /**
   * The value of a parameter, or the one it is moving to. Throws ParameterError where there is
   * none.
   * @param {string} address
   * @returns {number}
   */
  value(address) {
    const param = find(address);
    const { row, owned } = param;
    const known = owned ? this.#written.get(row)?.value : this.#interpreter?.values[row];
    const told = owned ? this.#sink.target?.(address) : this.#sink.told?.(address);
    return (this.#isRecent(row) ? known : (told ?? known)) ?? param.default;
  }

  /**
   * Set a parameter, until a controller moves it. Throws ParameterError where the address is unknown
   * or the value is not finite.
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   */
  write(address, value, frame = null) {
    const param = find(address);
    const accepted = accept(param, value);
    const interpreter = this.#interpreter;
    if (interpreter && param.row === SECTION && (this.#sink.people ?? 1) > 1) {
      interpreter.found[SECTION] = accepted;
      this.#post(this.#at(frame), WRITE, SECTION, this.#people(interpreter, 1), 0);
    } else this.#take(this.#at(frame), SET, param.row, accepted);
  }

  /**
   * Return to the player what direct writes took over.
   * @param {number | null} frame
   */
  release(frame = null) {
    this.#take(this.#at(frame), RELEASE);
  }

  // -- style -------------------------------------------------------------------------------

  /**
   * Set the parameters of a preset.
   * @param {string} name
   * @param {number | null} frame
   */
  applyPreset(name, frame = null) {
    const { values } = named(PRESETS, name);
    for (const [address, value] of Object.entries(values)) {
      this.#take(this.#at(frame), LOAD, find(address).row, value);
    }
  }

  /**
   * Tune the keys of MIDI, from the next note on.
   * @param {string} name
   */
  applyTuning(name) {
    this.#tuning = named(TUNINGS, name);
    if (this.#interpreter) writeTuning(this.#interpreter.tables(), this.#tuning);
  }

  /**
   * Take another mapping while notes sound.
   * @param {Mapping} mapping
   * @param {number | null} frame
   */
  remap(mapping, frame = null) {
    this.#mapping = mapping;
    if (this.#interpreter === null) return;
    const { nextSlot } = this.#interpreter;
    writeTables(this.#interpreter.tables(nextSlot), mapping, this.#tuning);
    this.#take(this.#at(frame), TABLES_TO, nextSlot);
  }

  // -- notes -------------------------------------------------------------------------------

  /**
   * Act on a MIDI message of a port, counted from 0; bytes that are none change nothing.
   * @param {ArrayLike<number>} bytes
   * @param {number | null} frame
   * @param {number} port
   */
  midi(bytes, frame = null, port = 0) {
    const { length, 0: status = 0, 1: one = 0, 2: two = 0 } = bytes;
    if (length > MOST_BYTES) return;
    const packed = status + one * 2 ** 8 + two * 2 ** 16 + length * 2 ** 24 + port * 2 ** 32;
    this.#take(this.#at(frame), MESSAGE, packed);
  }

  /**
   * End the notes of a port that is gone; without a frame, after all that is wished of it ahead.
   * @param {number} port
   * @param {number | null} frame
   */
  letGoOf(port, frame = null) {
    this.#take(frame === null ? this.#afterAll(null) : this.#at(frame), DISCONNECT, port);
  }

  /**
   * Put a finger at a pitch, whatever the tuning, and begin a note there. One that the same hand
   * still holds ends, slurred.
   * @param {NoteId} id
   * @param {number} at fractional MIDI note
   * @param {number} velocity 0 to 1
   * @param {number | null} frame
   */
  fingerOn(id, at, velocity, frame = null) {
    const before = this.#inHand.get(id);
    // Rounded so that the key is the same in single and double precision.
    const note = Math.round(within('pitch', at, HIGHEST_KEY) * 1000) / 1000;
    const strength = within('velocity', velocity, 1);
    const key = { channel: this.#freeChannel(), note };
    this.#inHand.set(id, key);
    this.#take(this.#at(frame), FINGER_ON, key.channel, note, strength);
    if (before !== undefined) this.#take(frame, NOTE_OFF, before.channel, before.note);
  }

  /**
   * End a note that `fingerOn` began.
   * @param {NoteId} id
   * @param {number | null} frame
   */
  noteOff(id, frame = null) {
    const key = this.#inHand.get(id);
    if (key === undefined) return;
    this.#inHand.delete(id);
    this.#take(this.#at(frame), NOTE_OFF, key.channel, key.note);
  }

  /**
   * A channel that no hand plays on: each note has one of a port of its own, so that two fingers
   * may be at one pitch.
   * @returns {number}
   */
  #freeChannel() {
    const taken = new Set([...this.#inHand.values()].map((key) => key.channel));
    let channel = ELSEWHERE;
    while (taken.has(channel)) channel -= CHANNELS;
    return channel;
  }

  /**
   * Slide the finger to a pitch: the sounding note slides; in silence, the finger waits there for
   * the bow.
   * @param {number} at fractional MIDI note
   * @param {number | null} frame
   */
  slide(at, frame = null) {
    const pitch = clamp(within('pitch', at, HIGHEST_KEY), LOWEST_NOTE, HIGHEST_NOTE);
    this.#take(this.#at(frame), SLIDE, 0, pitch);
  }

  /**
   * Draw the bow by hand at a speed (m/s) and force (N), on the string of the fingering. Takes the
   * bow over as direct writes do; 0 and 0 lift it.
   * @param {number} speed
   * @param {number} force
   * @param {number | null} frame
   */
  draw(speed, force, frame = null) {
    this.#take(this.#at(frame), DRAW, 0, accept(BOW_SPEED, speed), accept(BOW_FORCE, force));
  }

  /**
   * Lift a bow drawn by hand, and return it to the player.
   * @param {number | null} frame
   */
  lift(frame = null) {
    this.#take(this.#at(frame), LIFT);
  }

  /**
   * End all notes, as if all keys and pedals were released; lift a bow drawn by hand.
   * @param {number | null} frame
   */
  endNotes(frame = null) {
    const after = this.#afterAll(frame);
    this.#inHand.clear();
    this.#take(after, RELEASE_ALL, 0, 1);
    this.#take(after, LIFT);
  }

  /**
   * End all notes and all sound at once, whoever plays.
   * @param {number | null} frame
   */
  panic(frame = null) {
    this.endNotes(frame);
    const after = this.#afterAll(frame);
    if (this.#interpreter) this.#take(after, STOP, 0, 1);
    else this.#post(after, STOP, 0, 1, 0);
  }
}

/**
 * @template V
 * @param {Readonly<Record<string, V>>} all
 * @param {string} name
 * @returns {V}
 */
function named(all, name) {
  if (!Object.hasOwn(all, name)) throw new ParameterError(`there is no ${name}`);
  return all[name];
}

/**
 * @param {string} what
 * @param {number} value
 * @param {number} most
 * @returns {number}
 */
function within(what, value, most) {
  if (0 <= value && value <= most) return value; // also refuses NaN
  throw new ParameterError(`${what}: ${value} is not within 0 to ${most}`);
}
