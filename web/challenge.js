/** From scratch to tone in 20 seconds: how long the bow was in the full tone. */

export const LASTS = 20; // s
const SLOWEST = 0.04; // m/s that is a stroke

/**
 * What a hand makes of the string: by the bow force, between Schelleng's limits.
 * @param {import('./interfaces.js').Snapshot} state
 * @returns {'scratch' | 'tone' | 'light' | 'none'}
 */
export function toneOf({ bow, schelleng }) {
  if (bow.string < 0 || Math.abs(bow.speed) < SLOWEST) return "none";
  const force = Math.abs(bow.force);
  if (force > schelleng.max) return "scratch";
  return force < schelleng.min ? "light" : "tone";
}

export class Challenge {
  gone = 0; // s, since the first stroke
  tone = 0; // s, of full tone
  longest = 0; // s, of it at once
  /** When the tone came after a scratch, s after it. @type {number | null} */
  found = null;
  #run = 0;
  #scratched = NaN;

  get isOver() {
    return this.gone >= LASTS;
  }

  /**
   * Go on by some time, in which the string was bowed in one way.
   * @param {ReturnType<typeof toneOf>} kind
   * @param {number} seconds
   */
  take(kind, seconds) {
    if (this.isOver || (this.gone === 0 && kind === "none")) return;
    const lasted = Math.min(seconds, LASTS - this.gone);
    this.gone += lasted;
    if (kind === "scratch" && this.found === null) this.#scratched = this.gone;
    if (kind === "tone") {
      const isFound = this.found === null && !Number.isNaN(this.#scratched);
      if (isFound) this.found = this.gone - lasted - this.#scratched;
      this.tone += lasted;
      this.#run += lasted;
      this.longest = Math.max(this.longest, this.#run);
    } else if (kind !== "none") this.#run = 0; // a bow that turns stands for a moment
  }
}
