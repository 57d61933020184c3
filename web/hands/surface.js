/** Where on the stage the instrument's parts are: head, fingerboard, bow and coconut, along its strings. */

const HEAD = 0.06; // of the length, with the pegs
const MIN_HEAD = 30; // px
const ROUND = 0.115; // radius of the coconut, of the length
const WIDEST = 0.4; // and at most of the breadth
const EDGE = 8; // px beyond it
const BOW = 0.1; // of the length between fingerboard and coconut
const MIN_BOW = 56; // px
const OVER = 0.25; // of the radius that the bow may come over the coconut
/** The bow is somewhere between these distances from the bridge, as shares of the sounding length. */
const NEAREST = 0.03;
const FARTHEST = 0.5;

/** Event: 'change' when anything has moved. */
export class Surface extends EventTarget {
  /**
   * @param {HTMLElement} stage
   * @param {string} requested direction of rising pitches, "across" or "down"; else as the stage has room
   */
  constructor(stage, requested) {
    super();
    this.stage = stage;
    this.requested = requested;
    this.direction = "across";
    this.length = this.breadth = 1; // px
    this.board = [0, 1]; // where it begins and ends along the strings, px
    this.round = 1; // px, of the coconut
    new ResizeObserver(() => this.measure()).observe(stage);
    this.measure();
  }

  /** @param {string} requested */
  turn(requested) {
    this.requested = requested;
    this.measure();
  }

  measure() {
    const { clientWidth: width, clientHeight: height, style } = this.stage;
    const isRequested = ["across", "down"].includes(this.requested);
    this.direction = isRequested ? this.requested : height > width ? "down" : "across";
    this.stage.classList.toggle("down", this.isUpright);
    [this.length, this.breadth] = this.isUpright ? [height, width] : [width, height];
    this.round = Math.min(ROUND * this.length, WIDEST * this.breadth);
    const end = this.centre - this.round - Math.max(BOW * this.length, MIN_BOW);
    this.board = [Math.max(HEAD * this.length, MIN_HEAD), end];
    style.setProperty("--board-from", `${this.board[0]}px`);
    style.setProperty("--board-to", `${end}px`);
    this.dispatchEvent(new Event("change"));
  }

  get isUpright() {
    return this.direction === "down";
  }

  /** The middle of the coconut. */
  get centre() {
    return this.length - this.round - EDGE;
  }

  get bridge() {
    return this.centre + 0.1 * this.round;
  }

  /**
   * Where the bow crosses the strings.
   * @param {number} beta distance from the bridge, as a share of the sounding length
   */
  bowAt(beta) {
    const away = Math.log(Math.max(beta, NEAREST) / NEAREST) / Math.log(FARTHEST / NEAREST);
    const nearest = this.centre - (1 - OVER) * this.round;
    return nearest - Math.min(away, 1) * (nearest - this.board[1]);
  }

  /** Where across the strings a loudness is. @param {number} share 0: soft, 1: loud */
  loudnessAt(share) {
    return (this.isUpright ? share : 1 - share) * this.breadth;
  }
}
