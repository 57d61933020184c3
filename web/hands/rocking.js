/** Notices a finger that rocks to and fro, as in a vibrato. */

const LEAST = 0.03; // semitones from one turn to the next; less is a hand at rest
const MOST = 1.2; // and more is a slide
const SOONEST = 40; // ms from turn to turn
const LATEST = 350;
const TURNS = 3;

export class Rocking {
  constructor() {
    this.turns = 0;
    this.way = 0; // the direction in which it moves
    this.farthest = NaN; // where it came to on its way, and where it had turned
    this.turned = NaN;
    this.time = 0;
  }

  /**
   * Whether a finger rocks, being at a pitch.
   * @param {number} pitch
   * @param {number} time ms
   */
  isOn(pitch, time) {
    if (Number.isNaN(this.turned)) {
      [this.turned, this.farthest, this.time] = [pitch, pitch, time];
    }
    if ((pitch - this.farthest) * this.way >= 0 && this.way !== 0) this.farthest = pitch;
    else if (Math.abs(pitch - this.farthest) >= LEAST) {
      const size = Math.abs(this.farthest - this.turned);
      const lasted = time - this.time;
      const isTurn = this.way !== 0 && size <= MOST && lasted >= SOONEST && lasted <= LATEST;
      this.turns = isTurn ? this.turns + 1 : 0;
      [this.turned, this.time, this.way] = [this.farthest, time, Math.sign(pitch - this.farthest)];
      this.farthest = pitch;
    }
    return this.turns >= TURNS;
  }
}
