/** A bind: one source that moves one target, over what range, along which curve, for which notes. */

import facts from '../facts.js';
import * as curves from './curves.js';
import { BEND, withinPort } from './sources.js';
import { find } from './table.js';

const { LIN } = facts.spec.CURVES;
const { PICKUP_WINDOW } = facts.binds;

/**
 * The settings of a bind, as `facts.mappings` have them.
 * @typedef {object} BindFacts
 * @property {string} source canonical name of the source
 * @property {string} target address of the parameter
 * @property {readonly number[] | null} span the target's values at the two ends; null: its range
 * @property {curves.Curve} curve
 * @property {boolean} invert
 * @property {number} smoothingMs shortest time in which a move changes a sounding note
 * @property {readonly number[]} channels MIDI channels, 1 to 16; all if empty
 * @property {boolean} isSoft the target moves only once the source has reached its value
 * @property {readonly number[]} inputRange what an address of the page's own sends at its ends
 * @property {boolean} isExclusive
 * @property {boolean} isGlobal whether it moves every note, wherever the source is moved
 */

/** One source that moves one parameter. */
export class Bind {
  /** @param {BindFacts} settings */
  constructor(settings) {
    this.source = settings.source;
    this.target = settings.target;
    this.curve = settings.curve;
    this.smoothingMs = settings.smoothingMs;
    this.isSoft = settings.isSoft;
    this.isGlobal = settings.isGlobal;
    /** The same for binds that are alike, of whichever mapping. */
    this.key = JSON.stringify(settings);
    const { lo, hi } = find(settings.target);
    /** The target's values at the two ends of the span, before `invert`. */
    this.ends = settings.span ?? [lo, hi];
    const isBend = settings.source === BEND && settings.target === '/playing/bend';
    /** Whether the bend range (RPN 0) sets its span. */
    this.isByRange = isBend && settings.span === null;
    this.channels = settings.channels;
    this.inputRange = settings.inputRange;
    this.invert = settings.invert;
  }

  /**
   * Whether it receives on a channel, counted from 0 over all ports; negative: no channel.
   * @param {number} channel
   * @returns {boolean}
   */
  receives(channel) {
    if (this.channels.length === 0) return true;
    return channel >= 0 && this.channels.includes(withinPort(channel) + 1);
  }

  /**
   * Map the argument of an address to a position, 0 to 1.
   * @param {number} argument
   * @returns {number}
   */
  inputToUnit(argument) {
    return curves.toUnit(LIN, argument, this.inputRange[0], this.inputRange[1]);
  }

  /**
   * Map the source's position, 0 to 1, to the target's value.
   * @param {number} position
   * @returns {number}
   */
  fromUnit(position) {
    return curves.fromUnit(this.curve, this.#inverted(position), this.ends[0], this.ends[1]);
  }

  /**
   * Find the position, 0 to 1, that `fromUnit` maps to a value, clamped to the span.
   * @param {number} value
   * @returns {number}
   */
  toUnit(value) {
    return this.#inverted(curves.toUnit(this.curve, value, this.ends[0], this.ends[1]));
  }

  /**
   * Map the position of a pitch wheel to semitones, for a bend range in semitones.
   * @param {number} position
   * @param {number} bendRange
   * @returns {number}
   */
  semitones(position, bendRange) {
    return (2 * curves.fromUnit(this.curve, this.#inverted(position), 0, 1) - 1) * bendRange;
  }

  /**
   * Whether a source that moves to a position reaches or passes the target's present value.
   * @param {number} position
   * @param {number | null} before the source's position before, if it was ever moved
   * @param {number} value
   * @returns {boolean}
   */
  picksUp(position, before, value) {
    const here = this.#fraction(position);
    const there = this.#fractionOf(value);
    if (Math.abs(here - there) <= PICKUP_WINDOW || this.ends[0] === this.ends[1]) return true;
    return before !== null && (this.#fraction(before) - there) * (here - there) < 0;
  }

  /** @param {number} position */
  #inverted(position) {
    return this.invert ? 1 - position : position;
  }

  // Curves of points may fall or stay the same, so positions are compared by their fractions.

  /** @param {number} position */
  #fraction(position) {
    const unit = this.#inverted(position);
    return typeof this.curve === 'string' ? unit : curves.fractionAt(this.curve, unit);
  }

  /** @param {number} value */
  #fractionOf(value) {
    const [from, to] = this.ends;
    if (typeof this.curve === 'string') return curves.toUnit(this.curve, value, from, to);
    return curves.fractionOf(this.curve, value, from, to);
  }
}
