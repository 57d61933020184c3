/** Schelleng's limits of the bow force at every place of the bow, as they are told of one place. */

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */

const USUAL_BETA = 0.13;
/** N, of an ordinary stroke there. */
const USUAL_LEAST = 0.04;
const USUAL_MOST = 1.46;
const SMOOTH = 0.15; // s: they follow the bow's speed

export class Limits {
  constructor() {
    this.beta = USUAL_BETA;
    /** Logarithms of the limits at `beta`. */
    this.least = Math.log(USUAL_LEAST);
    this.most = Math.log(USUAL_MOST);
  }

  /**
   * Follow what is told of the bow.
   * @param {Pick<Snapshot, 'bow' | 'schelleng'>} state
   * @param {number} elapsed s
   */
  follow({ bow, schelleng: { min, max } }, elapsed) {
    if (bow.string < 0 || !(min > 0 && max > 0) || bow.speed === 0) return;
    const share = Math.min(elapsed / SMOOTH, 1);
    // Carried to where the bow is now, along their slopes, before they are averaged.
    const away = Math.log(this.beta / bow.beta);
    this.least += 2 * away;
    this.most += away;
    this.beta = bow.beta;
    this.least += share * (Math.log(min) - this.least);
    this.most += share * (Math.log(max) - this.most);
  }

  /**
   * The limits at a place (N): the least force falls with its square, the greatest with itself.
   * @param {number} beta
   */
  at(beta) {
    const away = Math.log(this.beta / beta);
    return { least: Math.exp(this.least + 2 * away), most: Math.exp(this.most + away) };
  }

  /** The place (beta) where both meet: nearer the bridge no force will do. */
  get tip() {
    return this.beta * Math.exp(this.least - this.most);
  }
}
