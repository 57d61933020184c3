/** The state of one MIDI channel: pedal, bend range, selected parameter and bank. */

import facts from '../facts.js';

export const { DATA_ENTRY, DATA_ENTRY_FINE, INCREMENT, DECREMENT } = facts.midiChannel;
export const { NRPN_FINE, NRPN, RPN_FINE, RPN } = facts.midiChannel;

/** The registered or non-registered parameter that data entry sets. */
export class Selected {
  /**
   * @param {boolean} isRegistered
   * @param {number | null} coarse null until received
   * @param {number | null} fine
   */
  constructor(isRegistered = true, coarse = null, fine = null) {
    this.isRegistered = isRegistered;
    this.coarse = coarse;
    this.fine = fine;
  }
}

/** What the messages on one channel have set up. */
export class MidiChannel {
  constructor() {
    /** Held notes, and the frame at which each was struck again. @type {Map<number, number>} */
    this.retriggered = new Map();
    /** Semitones, once RPN 0 has set it. @type {number | null} */
    this.bendRange = null;
    this.sustain = false;
    /** Keys released while the pedal is down. @type {Set<import('./keys.js').Key>} */
    this.sustained = new Set();
    this.selected = new Selected();
    this.bankCoarse = 0;
    this.bankFine = 0;
  }

  /**
   * Whether data entry sets a registered parameter, by its number.
   * @param {readonly number[]} registered its coarse and fine halves
   * @returns {boolean}
   */
  hasSelected(registered) {
    const { isRegistered, coarse, fine } = this.selected;
    return isRegistered && coarse === registered[0] && fine === registered[1];
  }

  /**
   * Select a parameter by one half of its number; RPN and NRPN do not mix.
   * @param {number} control
   * @param {number} value
   */
  select(control, value) {
    const isRegistered = control === RPN || control === RPN_FINE;
    if (this.selected.isRegistered !== isRegistered) this.selected = new Selected(isRegistered);
    if (control === RPN || control === NRPN) this.selected.coarse = value;
    else this.selected.fine = value;
  }
}
