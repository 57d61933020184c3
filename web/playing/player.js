/** The player: all control of the instrument, by hands, MIDI and presets, goes through it. */

import facts from "../facts.js";
import { MAPPINGS } from "./learned.js";
import { Part } from "./part.js";
import { ParameterError, accept, clamp, find } from "./table.js";

const { DRAW, LIFT, SLIDE, RELEASE } = facts.kinds;
const { MESSAGE, FINGER_ON, NOTE_OFF, LOAD, DISCONNECT, RELEASE_ALL } = facts.events;
const { LOWEST_NOTE, HIGHEST_NOTE, ELSEWHERE } = facts.notes;
const HIGHEST_KEY = facts.notes.KEYS - 1;
const { CHANNELS } = facts.sources;
const MAX_BYTES = 3; // of a message
/** @type {Readonly<Record<string, Tuning>>} */
const TUNINGS = facts.tunings;
/** @type {Readonly<Record<string, {values: Readonly<Record<string, number>>}>>} */
const PRESETS = facts.presets.shipped;
const [BOW_SPEED, BOW_FORCE] = ["/bow/speed", "/bow/force"].map(find);

/**
 * @typedef {import('./interpreter.js').Interpreter} Interpreter
 * @typedef {import('./learned.js').Mapping} Mapping
 * @typedef {import('./tables.js').Tuning} Tuning
 *
 * @typedef {number | string} NoteId Distinguishes notes that hands hold at one time.
 *
 * @typedef {object} Key
 * @property {number} channel
 * @property {number} note
 */

/**
 * Plays the instrument: each call is an event for the interpreter, which makes commands of it at a
 * frame, or now. Before there is an interpreter calls do nothing, but for `panic`.
 *
 * Frames may lie ahead, as of a tune that is played; `endNotes` and `panic` come after all of them.
 */
export class Player {
  #sink;
  #part;
  #mapping = MAPPINGS[facts.defaultMapping];
  /** @type {Tuning} */
  #tuning = TUNINGS.equal;
  #latest = 0; // the latest frame of any call
  /** The keys that hands hold. @type {Map<NoteId, Key>} */
  #inHand = new Map();

  /** @param {import('./part.js').Sink} sink */
  constructor(sink) {
    this.#sink = sink;
    this.#part = new Part(sink);
  }

  /** Play by an interpreter that was sent nothing. @param {Interpreter} interpreter */
  playBy(interpreter) {
    this.#part.interpreter = interpreter;
    this.remap(this.#mapping);
  }

  // -- frames ------------------------------------------------------------------------------

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
   * A frame after which nothing is requested yet, or now.
   * @param {number | null} frame
   * @returns {number | null}
   */
  #afterAll(frame) {
    if (frame !== null) return Math.max(this.#at(frame) ?? frame, this.#latest);
    const now = this.#sink.frame ?? 0;
    if (this.#latest > now + (this.#sink.rate ?? 0)) this.#latest = now;
    return this.#latest > now ? this.#latest : null;
  }

  // -- parameters --------------------------------------------------------------------------

  /**
   * The value of a parameter, or the one it is moving to. Throws ParameterError where there is
   * none.
   * @param {string} address
   * @returns {number}
   */
  value(address) {
    return this.#part.value(address);
  }

  /**
   * Set a parameter, until a controller moves it. Throws ParameterError where the address is unknown
   * or the value is not finite.
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   * @param {number} glideMs least time of the moves that follow
   */
  write(address, value, frame = null, glideMs = 0) {
    const param = find(address);
    this.#part.set(this.#at(frame), param, accept(param, value), glideMs);
  }

  /** Return to the player what direct writes took over. @param {number | null} frame */
  release(frame = null) {
    this.#part.take(this.#at(frame), RELEASE);
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
      this.#part.take(this.#at(frame), LOAD, find(address).index, value);
    }
  }

  /** Tune the keys of MIDI, from the next note on. @param {string} name */
  applyTuning(name) {
    this.#tuning = named(TUNINGS, name);
    this.#part.tune(this.#tuning);
  }

  /**
   * Take another mapping while notes sound.
   * @param {Mapping} mapping
   * @param {number | null} frame
   */
  remap(mapping, frame = null) {
    this.#mapping = mapping;
    this.#part.remap(this.#at(frame), mapping, this.#tuning);
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
    if (length > MAX_BYTES) return;
    const packed = status + one * 2 ** 8 + two * 2 ** 16 + length * 2 ** 24 + port * 2 ** 32;
    this.#part.take(this.#at(frame), MESSAGE, packed);
  }

  /**
   * End the notes of a port that is gone; without a frame, after all its commands ahead.
   * @param {number} port
   * @param {number | null} frame
   */
  endPortNotes(port, frame = null) {
    this.#part.take(frame === null ? this.#afterAll(null) : this.#at(frame), DISCONNECT, port);
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
    const note = Math.round(within("pitch", at, HIGHEST_KEY) * 1000) / 1000;
    const strength = within("velocity", velocity, 1);
    const key = { channel: this.#freeChannel(), note };
    this.#inHand.set(id, key);
    this.#part.take(this.#at(frame), FINGER_ON, key.channel, note, strength);
    if (before !== undefined) this.#part.take(frame, NOTE_OFF, before.channel, before.note);
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
    this.#part.take(this.#at(frame), NOTE_OFF, key.channel, key.note);
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
    const pitch = clamp(within("pitch", at, HIGHEST_KEY), LOWEST_NOTE, HIGHEST_NOTE);
    this.#part.take(this.#at(frame), SLIDE, 0, pitch);
  }

  /**
   * Draw the bow by hand at a speed (m/s) and force (N), on the string of the fingering. Takes the
   * bow over as direct writes do; 0 and 0 lift it.
   * @param {number} speed
   * @param {number} force
   * @param {number | null} frame
   */
  draw(speed, force, frame = null) {
    this.#part.take(this.#at(frame), DRAW, 0, accept(BOW_SPEED, speed), accept(BOW_FORCE, force));
  }

  /** Lift a bow drawn by hand, and return it to the player. @param {number | null} frame */
  lift(frame = null) {
    this.#part.take(this.#at(frame), LIFT);
  }

  /**
   * End all notes, as if all keys and pedals were released; lift a bow drawn by hand.
   * @param {number | null} frame
   * @param {boolean} forgets whether controllers count as not moved from now on
   */
  endNotes(frame = null, forgets = true) {
    const after = this.#afterAll(frame);
    this.#inHand.clear();
    this.#part.take(after, RELEASE_ALL, 0, Number(forgets));
    this.#part.take(after, LIFT);
  }

  /** The sound is another one from now on, which counts frames of its own. */
  restartFrames() {
    this.#latest = 0;
    this.#part.restartFrames();
  }

  /** End all notes and all sound at once, whoever plays. @param {number | null} frame */
  panic(frame = null) {
    this.endNotes(frame);
    this.#part.stop(this.#afterAll(frame));
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
