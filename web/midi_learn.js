/** What MIDI controllers move: the mapping that was chosen, with what this browser has learned over it. */

/** @typedef {import('./instrument.js').Instrument} Instrument */
/** @typedef {import('./playing/learned.js').LearnedBind} LearnedBind */

import facts from "./facts.js";
import {
  MAPPINGS,
  bindOf,
  fileOf,
  merged,
  readLearned,
  spanned,
  withBind,
  withoutBinds,
} from "./playing/learned.js";
import { Learner } from "./playing/learner.js";
import { remember, settings } from "./settings.js";

const PATIENCE = 60_000; // ms to wait for something to be moved

/**
 * Events: 'change' of the binds or the mapping, and 'wait' when a wait begins or ends.
 *
 * @typedef {object} Wait
 * @property {string} target
 * @property {boolean} isSoft
 * @property {boolean} isAlone
 * @property {Learner} learner
 * @property {number} timer
 */
export class MidiLearn extends EventTarget {
  /** @type {Wait | null} */
  #wait = null;

  /** @param {Instrument} instrument */
  constructor(instrument) {
    super();
    this.instrument = instrument;
    /** What the last wait has found; null: nothing was moved. @type {LearnedBind | null} */
    this.found = null;
    /** Targets that its source moved before. @type {string[]} */
    this.lost = [];
    this.isSoft = false; // whether what is learned next waits for its target
    this.isAlone = false; // and takes it away from all other controls
    /** Name of the mapping. */
    this.name = Object.hasOwn(MAPPINGS, settings.mapping) ? settings.mapping : facts.defaultMapping;
    /** Learned binds over this mapping. @type {readonly LearnedBind[]} */
    this.binds = readLearned(settings.learned[this.name]);
    this.#apply();
    instrument.addEventListener("silence", () => this.cancel());
  }

  /** @param {string} name of a shipped mapping */
  choose(name) {
    this.cancel();
    this.name = name;
    this.binds = readLearned(settings.learned[name]);
    remember({ mapping: name });
    this.#apply();
  }

  // -- learning ----------------------------------------------------------------------------

  /** The parameter for which a control is awaited; null: none is. */
  get awaited() {
    return this.#wait?.target ?? null;
  }

  /** Bind the control that is moved next. @param {string} target */
  await(target) {
    this.#end();
    this.found = null;
    const timer = window.setTimeout(() => this.cancel(), PATIENCE);
    const { isSoft, isAlone } = this;
    this.#wait = { target, isSoft, isAlone, learner: new Learner(), timer };
    this.dispatchEvent(new Event("wait"));
  }

  /** Await nothing more. */
  cancel() {
    if (!this.#wait) return;
    this.#end();
    this.dispatchEvent(new Event("wait"));
  }

  #end() {
    clearTimeout(this.#wait?.timer);
    this.#wait = null;
  }

  /**
   * Learn from a MIDI message, before it is played.
   * @param {Uint8Array} bytes
   * @param {number} port
   */
  hear(bytes, port) {
    const source = this.#wait?.learner.hear(bytes, port);
    if (!source || !this.#wait) return;
    const { target, isSoft, isAlone } = this.#wait;
    const before = this.targets(source);
    this.found = bindOf(target, source, isSoft, isAlone);
    this.#keep(withBind(this.binds, this.found));
    this.lost = before.filter((other) => !this.targets(source).includes(other));
    this.cancel();
  }

  // -- what was learned --------------------------------------------------------------------

  /** The targets that a source moves. @param {string} source */
  targets(source) {
    const binds = this.instrument.mapping.binds.filter((bind) => bind.source === source);
    return [...new Set(binds.map((bind) => bind.target))];
  }

  /** The sources that move a target. @param {string} target */
  movers(target) {
    const binds = this.instrument.mapping.binds.filter((bind) => bind.target === target);
    return [...new Set(binds.map((bind) => bind.source))];
  }

  /** @param {LearnedBind} bind */
  forget(bind) {
    this.#keep(withoutBinds(this.binds, [bind]));
  }

  /**
   * Give a bind other values of its target at the two ends.
   * @param {LearnedBind} bind
   * @param {number} from
   * @param {number} to
   */
  span(bind, from, to) {
    const changed = spanned(bind, from, to);
    this.#keep(this.binds.map((own) => (own === bind ? changed : own)));
  }

  /** All of it as a mapping file. */
  file() {
    const text = fileOf(this.name, MAPPINGS[this.name], this.binds);
    return { name: `my-${this.name}.toml`, blob: new Blob([text], { type: "application/toml" }) };
  }

  /** @param {readonly LearnedBind[]} binds */
  #keep(binds) {
    this.binds = binds;
    remember({ learned: { ...settings.learned, [this.name]: binds } });
    this.#apply();
  }

  #apply() {
    this.instrument.mapping = merged(MAPPINGS[this.name], this.binds);
    this.instrument.player.remap(this.instrument.mapping);
    this.dispatchEvent(new Event("change"));
  }
}
