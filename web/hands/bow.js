/** The bow: drawn across the strings by touch, pen, mouse or arrow keys. */

/** @typedef {import('./hands.js').Hands} Hands */
/** @typedef {import('./pointers.js').Touch} Touch */
/** @typedef {import('../interfaces.js').Snapshot} Snapshot */

import { Pointers } from "./pointers.js";

/** Length of hair that the breadth of the instrument is, m. */
const HAIR = 0.55;
/** The speed is that over so long, ms: shorter is uneven, longer is sluggish. */
const WINDOW = 45;
/** A finger of which nothing was heard for so long, ms, comes to rest within as much again. */
const RESTS_AFTER = 50;
const FASTEST = 1; // m/s
/** Bow force in newtons, from the fingerboard to the end of the coconut. */
const FORCES = /** @type {const} */ ([0.08, 4]);
/** With assist, from the least force to the greatest of the present note, and beyond by these. */
const BELOW = 0.6;
const ABOVE = 1.4;
const WIDEST_LEAST = 0.5; // where there is no wedge, forces near the greatest do best
/** With assist the force follows the speed, but a bow that turns stays on the string. */
const MIN_SPEED = 0.03;
/** Schelleng's limit for each m/s until the instrument reports it: 2 Z / (beta (mu_S - mu_C)). */
const USUAL_LIMIT = 7.3;
/** The least force as a share of the greatest, until the instrument reports it. */
const USUAL_LEAST = 0.03;
const KEYS_SPEED = 0.2; // m/s
const STROKES = { ArrowLeft: -1, ArrowRight: 1 };
const KEYS_STEP = 0.05; // of the height
const STILL = 0.002; // m/s; slower is at rest

export class Bow {
  /**
   * @param {HTMLElement} element
   * @param {Hands} hands
   * @param {import('./surface.js').Surface} surface
   */
  constructor(element, hands, surface) {
    this.element = element;
    this.hands = hands;
    this.surface = surface;
    /** @type {{place: number, time: number}[]} where across the strings the finger was of late, px and ms */
    this.way = [];
    this.height = 0.5; // of the finger: 0 at the fingerboard, lightest
    /** @type {number | null} the pointer that draws */
    this.by = null;
    this.keysSpeed = 0;
    this.limit = USUAL_LIMIT;
    this.least = USUAL_LEAST; // as a share of the limit
    this.pointers = new Pointers(element, {
      down: (touch) => this.#down(touch),
      move: (touches) => this.#move(touches),
      up: (id) => this.#up(id),
    });
    element.addEventListener("keydown", (event) => this.#press(event));
    element.addEventListener("keyup", (event) => this.#release(event));
    element.addEventListener("blur", () => this.#stopKeys());
    this.#announce();
  }

  /**
   * Learn how Schelleng's limit follows the speed at the present place.
   * @param {Snapshot} snapshot
   */
  follow({ bow, schelleng }) {
    const speed = Math.abs(bow.speed);
    if (speed > MIN_SPEED && schelleng.max > 0) {
      this.limit = schelleng.max / speed;
      this.least = schelleng.min / schelleng.max;
    }
  }

  /** @param {Touch} touch */
  #down(touch) {
    if (this.by !== null) return; // one bow
    this.#stopKeys();
    this.by = touch.id;
    this.way = [{ place: this.#across(touch), time: touch.time }];
    this.height = this.#heightOf(touch);
    this.hands.begin();
    this.#draw(0);
    requestAnimationFrame((now) => this.#tick(now));
  }

  /** @param {Touch[]} touches */
  #move(touches) {
    if (touches[0].id !== this.by) return;
    for (const touch of touches) this.way.push({ place: this.#across(touch), time: touch.time });
    const last = touches[touches.length - 1];
    this.height = this.#heightOf(last);
    this.#draw(this.#speedAt(last.time));
  }

  /** @param {number} id */
  #up(id) {
    if (id !== this.by) return;
    this.by = null;
    this.hands.liftBow();
  }

  /** Notice a finger that rests: no event reports it. @param {number} now ms */
  #tick(now) {
    if (this.by === null) return;
    this.#draw(this.#speedAt(now));
    requestAnimationFrame((next) => this.#tick(next));
  }

  /** Speed of the bow over the last moments, m/s. @param {number} now ms */
  #speedAt(now) {
    const last = this.way[this.way.length - 1];
    while (this.way.length > 2 && this.way[1].time <= last.time - WINDOW) this.way.shift();
    const [first] = this.way;
    // A finger that rested before it moved was not slow.
    const lasted = Math.min(Math.max(last.time - first.time, WINDOW / 3), 2 * WINDOW);
    const rests = Math.min(Math.max((now - last.time) / RESTS_AFTER - 1, 0), 1);
    const moved = ((last.place - first.place) / this.surface.breadth) * HAIR;
    const speed = (moved / lasted) * 1000 * (1 - rests);
    return Math.abs(speed) < STILL ? 0 : Math.min(Math.max(speed, -FASTEST), FASTEST);
  }

  /** @param {number} speed m/s */
  #draw(speed) {
    this.hands.draw(speed, this.forceAt(speed));
  }

  /**
   * The forces from the fingerboard to the end of the coconut: newtons; with assist, shares of the greatest
   * force with which the present note sounds.
   */
  get range() {
    if (!this.hands.isAssisted) return FORCES;
    return /** @type {const} */ ([BELOW * Math.min(this.least, WIDEST_LEAST), ABOVE]);
  }

  /** The bow force (N) at a speed, at the height of the finger. @param {number} speed m/s */
  forceAt(speed) {
    const [light, firm] = this.range;
    const amount = light * (firm / light) ** this.height;
    if (!this.hands.isAssisted) return amount;
    return Math.min(amount * this.limit * Math.max(Math.abs(speed), MIN_SPEED), 5);
  }

  /**
   * The heights between which the string sounds well, at the present speed; null at rest.
   * @returns {[number, number] | null}
   */
  get playable() {
    const [light, firm] = this.range;
    const speed = Math.abs(this.hands.stroke.speed);
    if (!this.hands.isAssisted && speed === 0) return null;
    const most = this.hands.isAssisted ? 1 : this.limit * speed;
    const heightOf = (/** @type {number} */ amount) =>
      Math.min(Math.max(Math.log(amount / light) / Math.log(firm / light), 0), 1);
    return [heightOf(most * this.least), heightOf(most)];
  }

  /** @param {Touch} touch */
  #heightOf({ x, y, pressure }) {
    const { isUpright, length, board } = this.surface;
    const share = (isUpright ? y : x) / (length - board[1]);
    return Math.min(Math.max(pressure ?? share, 0), 1);
  }

  /** @param {Touch} touch */
  #across({ x, y }) {
    return this.surface.isUpright ? x : y;
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in STROKES) {
      if (!event.repeat && this.by === null) {
        this.hands.begin();
        this.keysSpeed = STROKES[/** @type {keyof typeof STROKES} */ (event.key)] * KEYS_SPEED;
        this.#draw(this.keysSpeed);
      }
    } else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      const step = event.key === "ArrowDown" ? KEYS_STEP : -KEYS_STEP;
      this.height = Math.min(Math.max(this.height + step, 0), 1);
      if (this.keysSpeed !== 0) this.#draw(this.keysSpeed);
    } else {
      return;
    }
    this.#announce();
    event.preventDefault();
  }

  /** @param {KeyboardEvent} event */
  #release(event) {
    const way = STROKES[/** @type {keyof typeof STROKES} */ (event.key)];
    if (way * KEYS_SPEED === this.keysSpeed) this.#stopKeys();
  }

  #stopKeys() {
    if (this.keysSpeed === 0) return;
    this.keysSpeed = 0;
    this.hands.liftBow();
  }

  /** Announce to screen readers how firm the bow is. */
  #announce() {
    this.element.setAttribute("aria-valuemin", "0");
    this.element.setAttribute("aria-valuemax", "100");
    this.element.setAttribute("aria-valuenow", String(Math.round(this.height * 100)));
  }
}
