/** From scratch to tone in 20 seconds: how long the bow was in the full tone. */

export const LASTS = 20; // s
const SLOWEST = 0.04; // m/s that is a stroke
const BLINK = 0.15; // s that a turning bow may be in another way
const HELD = 0.3; // s after which a tone is found

/**
 * How the string is bowed: by the bow force, between Schelleng's limits.
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
  #run = 0; // s of tone until now
  #other = 0; // s of anything else until now
  #scratch = 0;
  #scratched = NaN; // when it last did

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
    if (kind === "none") return; // a bow that turns stands for a moment
    if (kind === "tone") {
      this.tone += lasted;
      this.#run += lasted;
      this.#other = this.#scratch = 0;
      this.longest = Math.max(this.longest, this.#run);
      if (this.found === null && this.#run >= HELD) {
        this.found = Number.isNaN(this.#scratched) ? null : this.gone - this.#run - this.#scratched;
      }
      return;
    }
    this.#other += lasted;
    if (this.#other > BLINK) this.#run = 0;
    if (kind !== "scratch") return;
    this.#scratch += lasted;
    if (this.#scratch > BLINK && this.found === null) this.#scratched = this.gone;
  }
}
