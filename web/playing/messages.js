/** Translates MIDI channel messages into notes and controller moves. */

import facts from '../facts.js';
import { Channels } from './channels.js';
import { Controllers } from './controllers.js';
import { keyOf } from './keys.js';
import * as midi from './midi_bytes.js';
import * as midiChannel from './midi_channel.js';
import { Notes } from './notes.js';
import { floorDivide, modulo, roundHalfEven } from './numbers.js';
import { Scope } from './scope.js';
import * as sources from './sources.js';
import { TABLE, accept, find } from './table.js';

const { BANK, BANK_FINE, SUSTAIN, SUSTAIN_SOURCE } = facts.messages;
const { ALL_SOUND_OFF, RESET_CONTROLLERS, ALL_NOTES_OFF } = facts.messages;
const { BEND_RANGE, MPE_CONFIGURATION } = facts.messages;
const { DATA_ENTRY, DATA_ENTRY_FINE, INCREMENT, DECREMENT } = midiChannel;
const SELECTS = [midiChannel.NRPN_FINE, midiChannel.NRPN, midiChannel.RPN_FINE, midiChannel.RPN];
const ENTERS = [DATA_ENTRY, DATA_ENTRY_FINE, INCREMENT, DECREMENT];
// Messages that global binds receive even on channels whose notes are not played.
const MOVES = [midi.CONTROL_CHANGE, midi.PITCH_WHEEL, midi.AFTERTOUCH];
const CENTRE = 8192; // of the pitch wheel
const WAY_UP = 8191; // from there
const DOWN = 64; // from here on a pedal is down

/**
 * @typedef {import('./keys.js').Key} Key
 * @typedef {import('./mapping.js').Mapping} Mapping
 * @typedef {import('./target_values.js').Values} Values
 *
 * @typedef {object} Options
 * @property {ReadonlySet<number> | null} [chosen] channels to receive, counted from 0; by default
 *   all. Notes of the percussion channel are played only if it is chosen, or a member of a zone.
 * @property {Iterable<readonly [string, number]>} [start] start values, over the mapping's
 * @property {(program: number) => Values | null} [programs] the values of the preset of a MIDI
 *   program, 1 to 128; without it program changes are ignored
 */

/** Turns MIDI channel messages into wishes: notes directly, controllers through a mapping. */
export class MidiPlayer {
  #wishes;
  #channels;
  #controllers;
  #notes;
  #programs;

  /**
   * @param {import('./wishes.js').Wishes} wishes
   * @param {Mapping} mapping
   * @param {Options} options
   */
  constructor(wishes, mapping, { chosen = null, start = [], programs } = {}) {
    this.#wishes = wishes;
    this.#channels = new Channels(wishes, chosen, () => this.mapping.mpe);
    const scope = new Scope(this.#channels);
    this.#controllers = new Controllers(wishes, mapping, this.#channels, scope, start);
    this.#notes = new Notes(wishes, this.#controllers, this.#channels, scope);
    this.#programs = programs;
    this.#controllers.begin(null);
  }

  /** The mapping in use; `remap` takes another. */
  get mapping() {
    return this.#controllers.mapping;
  }

  /**
   * Act on a channel message or a system reset; ignore others, and bytes that are none.
   *
   * Each port, counted from 0, has 16 channels of its own.
   * @param {ArrayLike<number>} bytes
   * @param {number | null} frame
   * @param {number} port
   */
  receive(bytes, frame = null, port = 0) {
    const kind = midi.kindOf(bytes);
    if (kind === null) return;
    if (kind === midi.SYSTEM_RESET) {
      this.reset(frame);
      return;
    }
    const channel = sources.CHANNELS * port + (bytes[0] & 0x0f);
    if (!this.#channels.plays(channel) && !this.#receives(kind)) return;
    const [first, second] = [bytes[1], bytes[2]];
    if (kind === midi.NOTE_ON && second > 0) {
      this.#notes.on(keyOf(channel, first), second / 127, frame);
    } else if (kind === midi.NOTE_ON || kind === midi.NOTE_OFF) {
      this.#notes.off(keyOf(channel, first), frame);
    } else if (kind === midi.PITCH_WHEEL) {
      const bend = Math.max(-1, ((first | (second << 7)) - CENTRE) / WAY_UP);
      this.#controllers.move(sources.BEND, channel, 0.5 * (bend + 1), frame);
    } else if (kind === midi.AFTERTOUCH) {
      this.#controllers.move(sources.PRESSURE, channel, first / 127, frame);
    } else if (kind === midi.POLY_TOUCH) {
      this.#controllers.movePolyPressure(keyOf(channel, first), second / 127, frame);
    } else if (kind === midi.CONTROL_CHANGE) {
      this.#control(channel, first, second, frame);
    } else if (kind === midi.PROGRAM_CHANGE) {
      this.#changeProgram(channel, first + 1, frame);
    }
  }

  /**
   * Move the targets of an address of the mapping, for all channels.
   * @param {string} address
   * @param {number} argument
   * @param {number | null} frame
   */
  move(address, argument, frame = null) {
    this.#controllers.moveAddress(address, argument, frame);
  }

  /**
   * Set a parameter for all channels, until a controller moves it; see `Wishes.write`.
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   * @returns {number}
   */
  write(address, value, frame = null) {
    return this.#controllers.write(address, value, frame);
  }

  /**
   * Take another mapping while notes sound; see `Controllers.remap`.
   * @param {Mapping} mapping
   * @param {number | null} frame
   */
  remap(mapping, frame = null) {
    const wasMpe = this.mapping.mpe;
    this.#controllers.remap(mapping, frame);
    if (mapping.mpe !== wasMpe) this.reset(frame);
    // A pedal that is bound holds no notes.
    if (mapping.of(SUSTAIN_SOURCE).length > 0) this.#notes.liftPedals(frame);
  }

  /**
   * Set the parameters of a preset, except held ones.
   * @param {Values} values
   * @param {number | null} frame
   */
  load(values, frame = null) {
    for (const [address, value] of values) {
      if (!this.#wishes.keeps(address)) this.write(address, value, frame);
    }
  }

  /** See `Controllers.positions`. */
  positions() {
    return this.#controllers.positions();
  }

  /** See `Controllers.sound`. */
  sound() {
    return this.#controllers.sound();
  }

  /**
   * End the notes of a port that is gone; see `Controllers.disconnect`.
   * @param {number} port
   * @param {number | null} frame
   */
  letGoOf(port, frame = null) {
    for (let own = 0; own < sources.CHANNELS; own += 1) {
      const channel = sources.CHANNELS * port + own;
      this.#notes.endChannel(channel, frame);
      this.#controllers.disconnect(channel, frame);
    }
    this.#channels.forgetZones(port);
  }

  /**
   * Set every parameter to its start value.
   * @param {number | null} frame
   */
  beginAgain(frame = null) {
    for (const isEngines of [false, true]) {
      for (const param of TABLE) {
        if ((param.slot !== null) === isEngines) this.write(param.address, param.default, frame);
      }
    }
    this.#controllers.begin(frame);
  }

  /**
   * End all notes, and forget pedals, zones and moves.
   * @param {number | null} frame
   */
  reset(frame = null) {
    this.#notes.endAll(frame);
    this.#channels.clear();
    this.#controllers.forgetAll(frame);
  }

  /**
   * Begin a note; `velocity` is 0 to 1.
   * @param {Key} key
   * @param {number} velocity
   * @param {number | null} frame
   */
  noteOn(key, velocity, frame = null) {
    this.#notes.on(key, velocity, frame);
  }

  /**
   * End a note, unless a pedal keeps it.
   * @param {Key} key
   * @param {number | null} frame
   */
  noteOff(key, frame = null) {
    this.#notes.off(key, frame);
  }

  /**
   * Whether global binds receive a message on channels whose notes are not played.
   * @param {number} kind
   * @returns {boolean}
   */
  #receives(kind) {
    return this.#channels.isAll && MOVES.includes(kind) && this.mapping.hasGlobal;
  }

  // -- control changes ---------------------------------------------------------------------

  /**
   * @param {number} channel
   * @param {number} control
   * @param {number} value
   * @param {number | null} frame
   */
  #control(channel, control, value, frame) {
    const state = this.#channels.at(channel);
    if (control >= ALL_SOUND_OFF && !this.#channels.plays(channel)) return;
    if (control === BANK) state.bankCoarse = value;
    if (control === BANK_FINE) state.bankFine = value;
    if (control === SUSTAIN && this.mapping.of(SUSTAIN_SOURCE).length === 0) {
      state.sustain = value >= DOWN;
      if (!state.sustain) this.#notes.liftPedal(state, frame);
    } else if (control === ALL_SOUND_OFF) {
      this.#notes.stopSound(channel, frame);
    } else if (control >= ALL_NOTES_OFF) {
      this.#notes.letGo(channel, frame); // the mode messages 124-127 include it
    } else if (control === RESET_CONTROLLERS) {
      this.#resetControllers(channel, frame);
    } else if (SELECTS.includes(control)) {
      state.select(control, value);
    } else if (ENTERS.includes(control)) {
      this.#dataEntry(channel, control, value, frame);
    } else {
      this.#moveControl(channel, control, value, frame);
    }
  }

  /**
   * Move the sources of a control change: the 7-bit one, then the 14-bit pair.
   * @param {number} channel
   * @param {number} control
   * @param {number} value
   * @param {number | null} frame
   */
  #moveControl(channel, control, value, frame) {
    this.#controllers.move(sources.control(control), channel, value / 127, frame);
    const coarse = control - sources.FINE_ABOVE;
    if (sources.isCoarse(control)) {
      this.#controllers.moveCoarse(sources.pair(control), channel, value, frame);
    } else if (sources.isCoarse(coarse)) {
      this.#controllers.moveFine(sources.pair(coarse), channel, value, frame);
    }
  }

  /**
   * @param {number} channel
   * @param {number} program
   * @param {number | null} frame
   */
  #changeProgram(channel, program, frame) {
    if (this.#programs === undefined) return;
    const { bankCoarse, bankFine } = this.#channels.at(channel);
    const values = bankCoarse === 0 && bankFine === 0 ? this.#programs(program) : null;
    if (values !== null) this.load(values, frame);
  }

  /**
   * @param {number} channel
   * @param {number | null} frame
   */
  #resetControllers(channel, frame) {
    this.#control(channel, SUSTAIN, 0, frame);
    this.#channels.at(channel).selected = new midiChannel.Selected();
    this.#controllers.reset(channel, frame);
  }

  // -- data entry --------------------------------------------------------------------------

  /**
   * @param {number} channel
   * @param {number} control
   * @param {number} value
   * @param {number | null} frame
   */
  #dataEntry(channel, control, value, frame) {
    const state = this.#channels.at(channel);
    if (!state.selected.isRegistered) {
      this.#enterNrpn(channel, control, value, frame);
    } else if (state.hasSelected(MPE_CONFIGURATION) && control === DATA_ENTRY) {
      this.#configureZone(channel, value, frame);
    } else if (state.hasSelected(BEND_RANGE)) {
      this.#enterBendRange(channel, control, value, frame);
    }
  }

  /**
   * @param {number} channel
   * @param {number} control
   * @param {number} value
   * @param {number | null} frame
   */
  #enterNrpn(channel, control, value, frame) {
    const { coarse, fine } = this.#channels.at(channel).selected;
    if (coarse === null || fine === null) return;
    const source = sources.nrpn((coarse << 7) | fine);
    if (control === DATA_ENTRY) {
      this.#controllers.moveCoarse(source, channel, value, frame);
    } else if (control === DATA_ENTRY_FINE) {
      this.#controllers.moveFine(source, channel, value, frame);
    } else {
      const steps = control === INCREMENT ? 1 : -1;
      this.#controllers.step(source, channel, steps, frame);
    }
  }

  /**
   * @param {number} channel
   * @param {number} control
   * @param {number} value
   * @param {number | null} frame
   */
  #enterBendRange(channel, control, value, frame) {
    const before = roundHalfEven(this.#channels.bendRange(channel) * 100);
    let [semitones, cents] = [floorDivide(before, 100), modulo(before, 100)];
    if (control === DATA_ENTRY) semitones = value;
    else if (control === DATA_ENTRY_FINE) cents = Math.min(value, 99);
    else semitones += control === INCREMENT ? 1 : -1;
    const bendRange = accept(find('/playing/bend_range'), semitones + cents / 100);
    this.#channels.setBendRange(channel, bendRange);
    this.#controllers.follow(sources.BEND, channel, frame);
  }

  /**
   * Create or end an MPE zone; the notes of its channels end and their state is forgotten.
   * @param {number} channel
   * @param {number} members
   * @param {number | null} frame
   */
  #configureZone(channel, members, frame) {
    const affected = this.#channels.configure(channel, members);
    if (affected.length === 0) return;
    for (const each of affected) {
      this.#notes.endChannel(each, frame);
      this.#controllers.forget(each);
    }
    const [coarse, fine] = MPE_CONFIGURATION;
    this.#channels.at(channel).selected = new midiChannel.Selected(true, coarse, fine);
  }
}
