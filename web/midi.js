/** The MIDI keyboards and controllers of this computer, by Web MIDI. */

/** @typedef {import('./instrument.js').Instrument} Instrument */
/** @typedef {import('./midi_learn.js').MidiLearn} MidiLearn */

const ALL = "";
const NOTE_ON = 0x90;

/** Events: 'change' of the inputs there are, and 'play' of a note. */
export class Midi extends EventTarget {
  /** Inputs by their order of coming: each has 16 channels of its own. @type {string[]} */
  #ports = [];
  /** @type {MIDIAccess | null} */
  #access = null;

  /** @param {Instrument} instrument @param {MidiLearn} taught */
  constructor(instrument, taught) {
    super();
    this.instrument = instrument;
    this.taught = taught;
    this.chosen = ALL; // id of the input that is listened to
    this.isAble = "requestMIDIAccess" in navigator;
    this.isRefused = false;
  }

  /** Key of the words that say why there is none. */
  get whyNot() {
    return window.isSecureContext ? "connect.none" : "connect.insecure";
  }

  get isOpen() {
    return this.#access !== null;
  }

  /** The inputs that are connected. */
  get inputs() {
    return [...(this.#access?.inputs.values() ?? [])].filter(({ state }) => state === "connected");
  }

  /** Ask for the inputs, and play what they send; the browser may ask whoever plays. */
  async open() {
    if (this.#access || !this.isAble) return;
    await this.instrument.start();
    try {
      this.#access = await navigator.requestMIDIAccess();
      this.#access.onstatechange = () => this.#listen();
      this.isRefused = false;
      this.#listen();
    } catch {
      this.isRefused = true;
      this.dispatchEvent(new Event("change"));
    }
  }

  /** @param {string} id of an input; '': listen to all */
  choose(id) {
    this.chosen = id;
    // Notes of inputs that are no longer listened to would never end.
    this.#ports.forEach((own, port) => {
      if (!this.#isHeard(own)) this.instrument.player.endPortNotes(port);
    });
  }

  #listen() {
    const { inputs } = this;
    if (!inputs.some(({ id }) => id === this.chosen)) this.chosen = ALL;
    // Browsers list inputs that were pulled out as disconnected, or no longer.
    this.#ports.forEach((own, port) => {
      if (!inputs.some(({ id }) => id === own)) this.instrument.player.endPortNotes(port);
    });
    inputs.forEach((input) => this.#hear(input));
    this.dispatchEvent(new Event("change"));
  }

  /** @param {MIDIInput} input */
  #hear(input) {
    if (!this.#ports.includes(input.id)) this.#ports.push(input.id);
    const port = this.#ports.indexOf(input.id);
    input.onmidimessage = ({ data }) => {
      if (!data || !this.#isHeard(input.id)) return;
      this.taught.hear(data, port);
      this.instrument.player.midi(data, null, port);
      if ((data[0] & 0xf0) === NOTE_ON && data[2] > 0) this.dispatchEvent(new Event("play"));
    };
  }

  /** @param {string} id */
  #isHeard(id) {
    return this.chosen === ALL || this.chosen === id;
  }
}
