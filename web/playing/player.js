/** The player: all control of the instrument, by hands, MIDI and presets, goes through it. */

import constants from '../facts.js';
import { keyOf } from './keys.js';
import { Mapping } from './mapping.js';
import { MidiPlayer } from './messages.js';
import { roundHalfEven } from './numbers.js';
import { morph, ofProgram } from './presets.js';
import { CHANNELS } from './sources.js';
import { ParameterError } from './table.js';
import { pitch } from './tuning.js';
import { Wishes } from './wishes.js';

const { ELSEWHERE } = constants.live;
const { STANDARD_A4 } = constants.tuning;
const EQUAL = { name: '', keys: null, fixed: false };

/**
 * @typedef {import('./keys.js').Key} Key
 * @typedef {import('./presets.js').Preset} Preset
 * @typedef {import('./tuning.js').Tuning} Tuning
 *
 * @typedef {object} Shipped The styles to choose from, as `facts.js` has them.
 * @property {Readonly<Record<string, import('./mapping.js').MappingFacts>>} mappings
 * @property {string} defaultMapping
 * @property {{shipped: Readonly<Record<string, Preset>>}} presets
 * @property {Readonly<Record<string, Tuning>>} tunings
 *
 * @typedef {object} Style How to play.
 * @property {string} [mapping] its name
 * @property {string | null} [tuning] its name; null: equal temperament
 * @property {number} [a4] Hz
 * @property {import('./wishes.js').RangePolicy} [policy] what happens to notes out of range
 * @property {string} [preset] its name
 * @property {boolean} [programs] whether program changes select presets
 * @property {readonly number[] | null} [channels] MIDI channels to receive, counted from 0; null:
 *   all but that of percussion
 *
 * @typedef {number | string} NoteId Tells notes that hands hold at one time apart.
 */

/**
 * Plays the instrument: each call becomes wishes at a frame, or now.
 *
 * Frames may lie ahead, as of a tune that is played; `endNotes`, `panic` and `reset` come after
 * all of them.
 */
export class Player {
  #facts;
  #sink;
  #wishes;
  #midi;
  #latest = 0; // the latest frame of any call
  /** @type {Tuning} */
  #tuning = EQUAL;
  #a4 = STANDARD_A4;
  /** The keys that hands hold. @type {Map<NoteId, Key>} */
  #inHand = new Map();
  /** Channels of fingers put at a pitch, which no tuning moves. @type {Set<number>} */
  #atPitch = new Set();

  /**
   * @param {Shipped} facts
   * @param {import('./wishes.js').Sink} sink
   * @param {Style} style
   */
  constructor(facts, sink, style = {}) {
    const { mapping = facts.defaultMapping, tuning = null, a4 = STANDARD_A4 } = style;
    this.#facts = facts;
    this.#sink = sink;
    this.#wishes = new Wishes(sink, style.policy, (key) => this.#pitchOf(key));
    const preset = style.preset === undefined ? null : this.#preset(style.preset);
    this.#midi = new MidiPlayer(this.#wishes, new Mapping(named(facts.mappings, mapping)), {
      start: Object.entries(preset?.values ?? {}),
      chosen: style.channels ? new Set(style.channels) : null,
      programs: style.programs ? (program) => this.#valuesOf(program) : undefined,
    });
    this.applyTuning(tuning, a4);
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
   * A frame after which nothing is wished yet, or now.
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
    return this.#wishes.value(address);
  }

  /**
   * Set a parameter; return the value accepted. Throws ParameterError as `Wishes.write`.
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   * @returns {number}
   */
  write(address, value, frame = null) {
    return this.#midi.write(address, value, this.#at(frame));
  }

  /**
   * Set a parameter, and hold it through notes, presets and moves until `release`.
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   * @returns {number}
   */
  hold(address, value, frame = null) {
    return this.#wishes.write(address, value, this.#at(frame), 0, true);
  }

  /**
   * Return to the player what direct writes took over.
   * @param {number | null} frame
   */
  release(frame = null) {
    this.#wishes.release(this.#at(frame));
  }

  /** The values that a preset keeps: see `Controllers.sound`. */
  sound() {
    return this.#midi.sound();
  }

  // -- style -------------------------------------------------------------------------------

  /**
   * Set the parameters of a preset, except held ones.
   * @param {string} name
   * @param {number | null} frame
   */
  applyPreset(name, frame = null) {
    this.#midi.load(new Map(Object.entries(this.#preset(name).values)), this.#at(frame));
  }

  /**
   * Set what lies between two presets; `amount` is 0 for the first and 1 for the other.
   * @param {string} one
   * @param {string} other
   * @param {number} amount
   * @param {number | null} frame
   */
  applyMorph(one, other, amount, frame = null) {
    this.#midi.load(morph(this.#preset(one), this.#preset(other), amount), this.#at(frame));
  }

  /**
   * Tune the keys, from the next note on.
   * @param {string | null} name null: equal temperament
   * @param {number} a4 Hz
   */
  applyTuning(name, a4 = this.#a4) {
    this.#tuning = name === null ? EQUAL : named(this.#facts.tunings, name);
    this.#a4 = a4;
  }

  /**
   * Take a shipped mapping while notes sound.
   * @param {string} name
   * @param {number | null} frame
   */
  applyMapping(name, frame = null) {
    this.remap(named(this.#facts.mappings, name), frame);
  }

  /**
   * Take a mapping that is not shipped, while notes sound.
   * @param {import('./mapping.js').MappingFacts} settings
   * @param {number | null} frame
   */
  remap(settings, frame = null) {
    this.#midi.remap(new Mapping(settings), this.#at(frame));
  }

  /** The mapping in use. */
  get mapping() {
    return this.#midi.mapping;
  }

  /**
   * Each bind, the position (0 to 1) its source was last moved to, and the target's value.
   * @returns {[import('./binds.js').Bind, number | null, number][]}
   */
  bindings() {
    const positions = this.#midi.positions();
    return positions.map(([bind, position]) => [bind, position, this.value(bind.target)]);
  }

  /** @param {string} name */
  #preset(name) {
    return named(this.#facts.presets.shipped, name);
  }

  /** @param {number} program */
  #valuesOf(program) {
    const preset = ofProgram(Object.values(this.#facts.presets.shipped), program);
    return preset && new Map(Object.entries(preset.values));
  }

  /** @param {Key} key */
  #pitchOf(key) {
    return this.#atPitch.has(key.channel) ? key.note : pitch(this.#tuning, key.note, this.#a4);
  }

  // -- notes -------------------------------------------------------------------------------

  /**
   * Act on a MIDI message of a port, counted from 0; bytes that are none change nothing.
   * @param {ArrayLike<number>} bytes
   * @param {number | null} frame
   * @param {number} port
   */
  midi(bytes, frame = null, port = 0) {
    this.#midi.receive(bytes, this.#at(frame), port);
  }

  /**
   * End the notes of a port that is gone; without a frame, after all that is wished of it ahead.
   * @param {number} port
   * @param {number | null} frame
   */
  letGoOf(port, frame = null) {
    this.#midi.letGoOf(port, frame === null ? this.#afterAll(null) : this.#at(frame));
  }

  /**
   * Move the targets of an address of the mapping, such as a sensor of the device.
   * @param {string} address
   * @param {number} argument
   * @param {number | null} frame
   */
  move(address, argument, frame = null) {
    this.#midi.move(address, argument, this.#at(frame));
  }

  /**
   * Press a key: begin a note of the tuning. One that the same hand still holds ends, slurred.
   * @param {NoteId} id
   * @param {number} note fractional MIDI note
   * @param {number} velocity 0 to 1
   * @param {number | null} frame
   */
  noteOn(id, note, velocity, frame = null) {
    this.#begin(id, note, velocity, frame, false);
  }

  /**
   * Put a finger at a pitch, whatever the tuning, and begin a note there; as `noteOn`.
   * @param {NoteId} id
   * @param {number} at fractional MIDI note
   * @param {number} velocity 0 to 1
   * @param {number | null} frame
   */
  fingerOn(id, at, velocity, frame = null) {
    this.#begin(id, at, velocity, frame, true);
  }

  /**
   * End a note that `noteOn` or `fingerOn` began.
   * @param {NoteId} id
   * @param {number | null} frame
   */
  noteOff(id, frame = null) {
    const key = this.#inHand.get(id);
    if (key === undefined) return;
    this.#inHand.delete(id);
    this.#midi.noteOff(key, this.#at(frame));
  }

  /**
   * @param {NoteId} id
   * @param {number} note
   * @param {number} velocity
   * @param {number | null} frame
   * @param {boolean} isAtPitch
   */
  #begin(id, note, velocity, frame, isAtPitch) {
    const before = this.#inHand.get(id);
    // Rounded so that the key is the same in single and double precision.
    const rounded = roundHalfEven(within('note', note, 127) * 1000) / 1000;
    const strength = within('velocity', velocity, 1);
    const key = keyOf(this.#freeChannel(), rounded);
    if (isAtPitch) this.#atPitch.add(key.channel);
    else this.#atPitch.delete(key.channel);
    this.#inHand.set(id, key);
    this.#midi.noteOn(key, strength, this.#at(frame));
    if (before !== undefined) this.#midi.noteOff(before, frame);
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
   * See `Wishes.slide`.
   * @param {number} at fractional MIDI note
   * @param {number | null} frame
   * @returns {number}
   */
  slide(at, frame = null) {
    return this.#wishes.slide(within('pitch', at, 127), this.#at(frame));
  }

  /**
   * See `Wishes.draw`.
   * @param {number} speed
   * @param {number} force
   * @param {number | null} frame
   * @returns {[number, number]}
   */
  draw(speed, force, frame = null) {
    return this.#wishes.draw(speed, force, this.#at(frame));
  }

  /**
   * See `Wishes.lift`.
   * @param {number | null} frame
   */
  lift(frame = null) {
    this.#wishes.lift(this.#at(frame));
  }

  /**
   * End all notes, as if all keys and pedals were released; lift a bow drawn by hand.
   * @param {number | null} frame
   */
  endNotes(frame = null) {
    const after = this.#afterAll(frame);
    this.#inHand.clear();
    this.#midi.reset(after);
    this.#wishes.lift(after);
  }

  /**
   * End all notes and all sound at once.
   * @param {number | null} frame
   */
  panic(frame = null) {
    this.endNotes(frame);
    this.#wishes.stopSound(this.#afterAll(frame), true);
  }

  /**
   * As `panic`, and set every parameter to its start value.
   * @param {number | null} frame
   */
  reset(frame = null) {
    this.#midi.beginAgain(this.#afterAll(frame));
    this.panic(frame);
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
