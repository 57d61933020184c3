/** The names of sources: MIDI controllers, properties of a note, addresses of the page's own. */

import facts from '../facts.js';
import { floorDivide, modulo } from './numbers.js';

export const { BEND, PRESSURE, POLY_PRESSURE, VELOCITY, NOTE } = facts.sources;
export const { FINE_ABOVE, STEPS, FINEST, CHANNELS } = facts.sources;
const [FIRST_COARSE, LAST_COARSE] = facts.sources.COARSE;

// Made once: a name is looked up with every message.
const CONTROLS = Array.from({ length: STEPS + 1 }, (_, number) => `cc ${number}`);
const PAIRS = CONTROLS.map((name, number) => `${name}/${number + FINE_ABOVE}`);

/**
 * The source of a 7-bit control change.
 * @param {number} number
 */
export const control = (number) => CONTROLS[number];

/**
 * The source of two control changes that make 14 bits, by the number of the coarse one.
 * @param {number} coarse
 */
export const pair = (coarse) => PAIRS[coarse];

/**
 * The source of a non-registered parameter, 0 to 16382.
 * @param {number} number
 */
export const nrpn = (number) => `nrpn ${number}`;

/**
 * Whether a controller has a fine half, `FINE_ABOVE` higher.
 * @param {number} number
 */
export const isCoarse = (number) => FIRST_COARSE <= number && number <= LAST_COARSE;

/**
 * Whether a source belongs to one note.
 * @param {string} source
 */
export const isOfOneNote = (source) => facts.sources.OF_ONE_NOTE.includes(source);

/**
 * The port of a channel, both counted from 0, channels over all ports.
 * @param {number} channel
 */
export const portOf = (channel) => floorDivide(channel, CHANNELS);

/**
 * A channel as its port counts it, 0 to 15.
 * @param {number} channel
 */
export const withinPort = (channel) => modulo(channel, CHANNELS);
