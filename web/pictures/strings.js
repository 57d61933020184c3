/** Both strings as they move, with bow and fingers on them. */

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */
/** @typedef {import('./picture.js').Moment} Moment */
/** @typedef {'slowed' | 'moving' | 'still'} View */

import { POINTS } from "../sound/snapshot.js";
import { translate } from "../i18n.js";
import { Picture, font } from "./picture.js";
import { RestShape } from "./rest_shape.js";
import { Stroboscope } from "./stroboscope.js";

const STRINGS = /** @type {const} */ (["inner", "outer"]);
/** Periods a second in the slowed view. */
const SLOW = 0.4;
/** The picture's scale follows the greatest swing, m; a smaller one is not drawn larger. */
const LEAST_SWING = 0.15e-3;
const FALL = 0.985; // of the greatest swing, a frame
const TRAIL = 10; // shapes that are still seen, in the view of all
const SIDE = 14; // px left and right
const ROOM_FOR_SCALE = 120; // px of height

export class Strings extends Picture {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    super(canvas);
    /** @type {View} still: the room in which they move, and no motion */
    this.view = "slowed";
    this.slow = [new Stroboscope(), new Stroboscope()];
    this.rests = [new RestShape(), new RestShape()];
    /** @type {[Float32Array[], Float32Array[]]} the latest shapes, the last one last */
    this.trails = [[], []];
    this.swing = LEAST_SWING;
    this.phase = 0;
    this.hair = 0; // m of hair that have passed
  }

  get isWanted() {
    return this.view !== "still";
  }

  /** @param {Moment} moment */
  notice({ state, isNew }) {
    if (state && isNew) this.#collect(state);
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Moment} moment
   */
  draw(context, { state, elapsed }) {
    if (this.view === "slowed") this.phase += SLOW * elapsed;
    if (state && this.view !== "still") this.hair += state.bow.speed * elapsed;
    const lane = this.height / 2;
    const room = lane * 0.36;
    this.#ends(context);
    for (const string of /** @type {const} */ ([0, 1])) {
      const middle = lane * (string + 0.5);
      this.#string(context, string, middle, room / this.swing);
    }
    if (state) {
      for (const finger of state.fingers) this.#finger(context, state, finger);
      if (state.bow.string >= 0) this.#bow(context, state, lane * (state.bow.string + 0.5), lane);
      if (this.height >= ROOM_FOR_SCALE) this.#scale(context, room);
    }
  }

  /** @param {Snapshot} state */
  #collect(state) {
    let swing = LEAST_SWING;
    for (const string of /** @type {const} */ ([0, 1])) {
      const shape = this.rests[string].without(state.shape[string], state);
      if (this.rests[string].isNew) {
        this.slow[string].clear();
        this.trails[string].length = 0;
      }
      for (const y of shape) swing = Math.max(swing, Math.abs(y));
      this.slow[string].add(shape, state.time, state.period);
      this.trails[string].push(shape);
      if (this.trails[string].length > TRAIL) this.trails[string].shift();
    }
    this.swing = Math.max(swing, this.swing * FALL);
  }

  /** @param {number} x of the string's length: 0 at the loop, 1 at the bridge */
  #place(x) {
    return SIDE + x * (this.width - 2 * SIDE);
  }

  /** @param {CanvasRenderingContext2D} context */
  #ends(context) {
    context.fillStyle = this.colours.line;
    for (const x of [0, 1])
      context.fillRect(this.#place(x) - 1.5, this.height * 0.08, 3, this.height * 0.84);
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {0 | 1} string
   * @param {number} middle px
   * @param {number} gain px for a metre
   */
  #string(context, string, middle, gain) {
    const colour = this.colours[STRINGS[string]];
    const trail = this.trails[string];
    context.strokeStyle = this.colours.line;
    context.lineWidth = 1;
    context.setLineDash([2, 5]);
    context.beginPath();
    context.moveTo(this.#place(0), middle);
    context.lineTo(this.#place(1), middle);
    context.stroke();
    context.setLineDash([]);
    this.#envelope(context, string, middle, gain);
    context.lineCap = context.lineJoin = "round";
    context.strokeStyle = colour;
    if (this.view === "moving") {
      trail.forEach((shape, i) => {
        context.globalAlpha = i === trail.length - 1 ? 1 : (0.3 * (i + 1)) / TRAIL;
        this.#line(context, shape, middle, gain, i === trail.length - 1 ? 2 : 1);
      });
      context.globalAlpha = 1;
    } else if (this.view === "slowed" && this.slow[string].known > 0) {
      this.#line(context, this.slow[string].at(this.phase), middle, gain, 2.2);
    }
    if (!trail.length) this.#line(context, new Float32Array(POINTS), middle, gain, 2);
    context.fillStyle = this.colours.soft;
    context.font = font(12);
    context.textBaseline = "top";
    context.textAlign = "left";
    context.fillText(
      translate(`strings.${STRINGS[string]}`),
      this.#place(0) + 8,
      string * (this.height / 2) + 6,
    );
  }

  /**
   * The room in which the string has moved of late.
   * @param {CanvasRenderingContext2D} context
   * @param {0 | 1} string
   * @param {number} middle
   * @param {number} gain
   */
  #envelope(context, string, middle, gain) {
    const shapes = [
      ...this.trails[string],
      ...this.slow[string].bins.filter((_, bin) => this.slow[string].isKnown(bin)),
    ];
    if (shapes.length < 2) return;
    context.globalAlpha = 0.13;
    context.fillStyle = this.colours[STRINGS[string]];
    context.beginPath();
    for (let i = 0; i < POINTS; i++) {
      const most = shapes.reduce((found, shape) => Math.max(found, shape[i]), 0);
      context.lineTo(this.#place(i / (POINTS - 1)), middle - gain * most);
    }
    for (let i = POINTS - 1; i >= 0; i--) {
      const least = shapes.reduce((found, shape) => Math.min(found, shape[i]), 0);
      context.lineTo(this.#place(i / (POINTS - 1)), middle - gain * least);
    }
    context.fill();
    context.globalAlpha = 1;
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Float32Array} shape
   * @param {number} middle
   * @param {number} gain
   * @param {number} width
   */
  #line(context, shape, middle, gain, width) {
    context.lineWidth = width;
    context.beginPath();
    for (let i = 0; i < shape.length; i++) {
      context.lineTo(this.#place(i / (shape.length - 1)), middle - gain * shape[i]);
    }
    context.stroke();
  }

  /**
   * A finger stops both strings at once.
   * @param {CanvasRenderingContext2D} context
   * @param {Snapshot} state
   * @param {{x: number, press: number}} finger
   */
  #finger(context, state, { x, press }) {
    const place = this.#place(x / state.string.length);
    const wide = 7 + Math.min(press, 6);
    context.globalAlpha = 0.22;
    context.fillStyle = this.colours.ink;
    context.beginPath();
    context.roundRect(place - wide, this.height * 0.14, wide, this.height * 0.72, wide / 2);
    context.fill();
    context.globalAlpha = 1;
  }

  /**
   * The hair on one string: a ribbon seen from its edge, that moves as it is drawn.
   * @param {CanvasRenderingContext2D} context
   * @param {Snapshot} state
   * @param {number} middle
   * @param {number} lane
   */
  #bow(context, { bow, string }, middle, lane) {
    const place = this.#place(bow.x / string.length);
    const wide = 5 + 3 * Math.min(Math.abs(bow.force), 3);
    const top = middle - lane * 0.44;
    const tall = lane * 0.88;
    context.save();
    context.beginPath();
    context.roundRect(place - wide / 2, top, wide, tall, 3);
    context.globalAlpha = 0.75;
    context.fillStyle = this.colours.glow;
    context.fill();
    context.clip();
    context.globalAlpha = 0.9;
    context.strokeStyle = this.colours.ink;
    context.lineWidth = 1;
    const gap = 12;
    const shift = (((-this.hair * 500) % gap) + gap) % gap; // 500 px for a metre: its way is seen
    for (let y = top - gap + shift; y < top + tall; y += gap) {
      context.beginPath();
      context.moveTo(place - wide, y);
      context.lineTo(place + wide, y + 3);
      context.stroke();
    }
    context.restore();
  }

  /**
   * How many times larger than life the swing is drawn.
   * @param {CanvasRenderingContext2D} context
   * @param {number} room px for the greatest swing
   */
  #scale(context, room) {
    const size = (this.swing * 1000).toFixed(1);
    context.fillStyle = context.strokeStyle = this.colours.soft;
    context.font = font(11);
    context.textAlign = "right";
    context.textBaseline = "middle";
    const x = this.#place(1) - 10;
    const y = this.height / 4 - room;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x - 3, y);
    context.lineTo(x + 3, y);
    context.moveTo(x, y);
    context.lineTo(x, y + room);
    context.moveTo(x - 3, y + room);
    context.lineTo(x + 3, y + room);
    context.stroke();
    context.fillText(`${size} mm`, x - 8, y + room / 2);
  }
}
