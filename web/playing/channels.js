/** What MIDI messages have set up for each channel, counted from 0 over all ports. */

import facts from '../facts.js';
import { DefaultMap } from './default_map.js';
import { MidiChannel } from './midi_channel.js';
import { CHANNELS, portOf, withinPort } from './sources.js';
import { Zones } from './zones.js';

const { PERCUSSION } = facts.messages;

/** @typedef {import('./scope.js').ChannelRules} ChannelRules */

/**
 * The state of the channels and zones of all ports.
 * @implements {ChannelRules}
 */
export class Channels {
  #wishes;
  #chosen;
  /** @type {DefaultMap<number, Zones>} */
  #zones;
  /** @type {DefaultMap<number, MidiChannel>} */
  #states = new DefaultMap(() => new MidiChannel());

  /**
   * @param {import('./wishes.js').Wishes} wishes
   * @param {ReadonlySet<number> | null} chosen see `MidiPlayer`
   * @param {() => boolean} isMpe whether a port begins as one zone
   */
  constructor(wishes, chosen, isMpe) {
    this.#wishes = wishes;
    this.#chosen = chosen;
    this.#zones = new DefaultMap(() => new Zones(isMpe()));
  }

  /**
   * The state of a channel.
   * @param {number} channel
   * @returns {MidiChannel}
   */
  at(channel) {
    return this.#states.at(channel);
  }

  /** The channels with a state, and their states, in the order of their first messages. */
  get states() {
    return [...this.#states];
  }

  /** Whether all channels are received but those whose notes are not played. */
  get isAll() {
    return this.#chosen === null;
  }

  /**
   * See `ChannelRules`.
   * @param {number} channel
   * @returns {boolean}
   */
  plays(channel) {
    const own = withinPort(channel);
    if (this.#chosen !== null) return this.#chosen.has(own);
    return own !== PERCUSSION || this.master(channel) !== null;
  }

  /**
   * See `ChannelRules`.
   * @param {number} channel
   * @returns {number | null}
   */
  master(channel) {
    const port = portOf(channel);
    const master = this.#zones.at(port).master(withinPort(channel));
    return master === null ? null : CHANNELS * port + master;
  }

  /**
   * A channel and, if it is the master of a zone, its members.
   * @param {number} channel
   * @returns {number[]}
   */
  zone(channel) {
    const port = portOf(channel);
    const members = this.#zones.at(port).members(withinPort(channel));
    return [channel, ...members.map((member) => CHANNELS * port + member)];
  }

  /**
   * Act on an MPE configuration message; return the channels that it affects, in order, none
   * where the channel can be no master.
   * @param {number} channel
   * @param {number} members
   * @returns {number[]}
   */
  configure(channel, members) {
    const before = this.zone(channel);
    if (!this.#zones.at(portOf(channel)).configure(withinPort(channel), members)) return [];
    const affected = new Set([...before, ...this.zone(channel)]);
    return [...affected].sort((one, other) => one - other);
  }

  /**
   * See `ChannelRules`.
   * @param {number} channel
   * @returns {number}
   */
  bendRange(channel) {
    const wished = this.#wishes.value('/playing/bend_range');
    if (this.#wishes.keeps('/playing/bend_range')) return wished;
    const received = this.at(channel).bendRange;
    return received ?? this.#zones.at(portOf(channel)).bendRange(withinPort(channel)) ?? wished;
  }

  /**
   * Set the bend range of a channel; one member of a zone sets the range of all.
   * @param {number} channel
   * @param {number} semitones
   */
  setBendRange(channel, semitones) {
    this.at(channel).bendRange = semitones;
    const master = this.master(channel);
    if (master === null) return;
    for (const member of this.zone(master).slice(1)) this.at(member).bendRange = semitones;
  }

  /**
   * Forget the state of a channel.
   * @param {number} channel
   */
  forget(channel) {
    this.#states.delete(channel);
  }

  /**
   * Forget the zones of a port.
   * @param {number} port
   */
  forgetZones(port) {
    this.#zones.delete(port);
  }

  /** Forget all states and zones. */
  clear() {
    this.#states.clear();
    this.#zones.clear();
  }
}
