/** Mappings: which controllers move which parameters. */

import { Bind } from './binds.js';

/**
 * A mapping as `facts.mappings` have it, merged with its bases.
 * @typedef {object} MappingFacts
 * @property {string} name
 * @property {string} about what it is for, in a line
 * @property {boolean} mpe whether every port starts as an MPE zone
 * @property {Readonly<Record<string, number>>} start values that parameters start with
 * @property {readonly import('./binds.js').BindFacts[]} binds
 */

/** @type {readonly Bind[]} */
const NONE = [];

/** A named set of binds; several may share a source or a target (the last move counts). */
export class Mapping {
  /** @type {Map<string, Bind[]>} */
  #bySource = new Map();

  /** @param {MappingFacts} settings */
  constructor(settings) {
    this.name = settings.name;
    this.mpe = settings.mpe;
    /** @type {ReadonlyMap<string, number>} */
    this.start = new Map(Object.entries(settings.start));
    this.binds = settings.binds.map((each) => new Bind(each));
    this.hasGlobal = this.binds.some((bind) => bind.isGlobal);
    for (const bind of this.binds) {
      this.#bySource.set(bind.source, [...this.of(bind.source), bind]);
    }
  }

  /**
   * The binds of one source.
   * @param {string} source
   * @returns {readonly Bind[]}
   */
  of(source) {
    return this.#bySource.get(source) ?? NONE;
  }

  /** All sources that are bound. */
  get sources() {
    return [...this.#bySource.keys()];
  }
}
