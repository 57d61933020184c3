/** Both strings in motion: slowed or as they are, glowing as they are loud. */

/** @typedef {import("../interfaces.js").Snapshot} Snapshot */
/** @typedef {'slowed' | 'moving' | 'still'} View still: the room in which they move, and no motion */

import { POINTS, playedString } from "../sound/snapshot.js";
import { RestShape, Stroboscope } from "./stroboscope.js";
import { line } from "./picture.js";
import { laneOf } from "./wood.js";

export const STRINGS = /** @type {const} */ (["inner", "outer"]);
/** Periods a second in the slowed view. */
const SLOW = 0.4;
/** A swing that is smaller, in m, is not drawn larger. */
const MIN_SWING = 0.15e-3;
const USUAL_SWING = 0.6e-3;
const SWING = 0.15; // of the breadth, for the greatest swing of a note
const MAX_SWING = 80; // px
const TRAIL = 10; // shapes that are still seen, in the view of all
const QUIET = -55; // dBFS; from here on a string glows
const LOUD = -15;
const SILENT = -60;
const STILL = new Float32Array(POINTS);

export class Strings {
  constructor() {
    /** @type {View} */
    this.view = "slowed";
    this.bowed = 0; // the one that was bowed, or plucked, last
    this.both = [0, 1].map(() => ({
      slow: new Stroboscope(),
      rest: new RestShape(),
      trail: /** @type {Float32Array[]} */ ([]), // the latest shapes, the last one last
    }));
    this.phase = 0;
    /** A note keeps its scale, which is that of the note before, unless it swings farther. */
    this.swing = USUAL_SWING;
    this.widest = 0; // of the present note
    this.note = NaN;
  }

  /** @param {Snapshot} state */
  collect(state) {
    const string = playedString(state);
    if (string >= 0) this.bowed = string;
    const note = string < 0 ? NaN : Math.round(state.pitch);
    if (note !== this.note) {
      if (this.widest > 0) this.swing = Math.max(this.widest, MIN_SWING);
      this.widest = 0;
      this.note = note;
    }
    this.both.forEach(({ slow, rest, trail }, i) => {
      const shape = rest.without(state.shape[i], state);
      if (rest.isNew) {
        slow.clear();
        trail.length = 0;
      }
      if (!rest.isSettled) return;
      if (i === string) {
        for (const y of shape) this.widest = Math.max(this.widest, Math.abs(y));
        this.swing = Math.max(this.swing, this.widest);
      }
      slow.add(shape, state.time, state.period);
      trail.push(shape);
      if (trail.length > TRAIL) trail.shift();
    });
  }

  /** @param {number} elapsed s */
  go(elapsed) {
    if (this.view === "slowed") this.phase += SLOW * elapsed;
  }

  /**
   * @param {import("./yehu.js").Yehu} yehu whose context goes along and across the strings
   * @param {number} level dBFS
   * @param {[number, number][]} knots places on the string (m) and on the picture (px)
   */
  draw({ context, surface, colours }, level, knots) {
    const along = placesOf(knots);
    const side = surface.isUpright ? 1 : -1;
    const gain = (side * Math.min(SWING * surface.breadth, MAX_SWING)) / this.swing;
    context.lineCap = context.lineJoin = "round";
    for (const string of [0, 1]) {
      const lane = laneOf(surface, string);
      context.strokeStyle = context.fillStyle = colours[STRINGS[string]];
      context.lineWidth = 1.5;
      const peg = surface.board[0] * (string ? 0.34 : 0.68);
      line(context, [peg, lane], [along[0], lane]);
      // Else it only gives way to a finger that sways.
      const isHeard = level > SILENT && string === this.bowed;
      this.#string(context, string, along, (y) => lane + gain * y, isHeard ? level : SILENT);
    }
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {number} string
   * @param {number[]} along
   * @param {(y: number) => number} across
   * @param {number} level dBFS
   */
  #string(context, string, along, across, level) {
    const { view } = this;
    const { slow, trail } = this.both[string];
    const isHeard = level > SILENT;
    if (isHeard) this.#envelope(context, string, along, across);
    const draw = (/** @type {Float32Array} */ shape, /** @type {number} */ width) => {
      context.lineWidth = width;
      line(context, ...along.map((x, i) => /** @type {const} */ ([x, across(shape[i])])));
    };
    /** @type {Float32Array} */
    let shape = STILL;
    if (isHeard && view === "slowed" && slow.isSeen) shape = slow.at(this.phase);
    else if (isHeard && view === "moving" && trail.length) shape = trail[trail.length - 1];
    const glow = Math.min(Math.max((level - QUIET) / (LOUD - QUIET), 0), 1);
    for (const width of glow > 0 ? [16, 9, 5] : []) {
      context.globalAlpha = 0.16 * glow;
      draw(shape, width);
    }
    if (view === "moving") {
      trail.slice(0, -1).forEach((one, i) => {
        context.globalAlpha = (0.3 * (i + 1)) / TRAIL;
        draw(one, 1);
      });
    }
    context.globalAlpha = 1;
    draw(shape, 2.2);
  }

  /**
   * The room in which the string has moved of late.
   * @param {CanvasRenderingContext2D} context
   * @param {number} string
   * @param {number[]} along
   * @param {(y: number) => number} across
   */
  #envelope(context, string, along, across) {
    const { slow, trail } = this.both[string];
    const shapes = [...trail, ...slow.bins.filter((_, bin) => slow.isKnown(bin))];
    if (shapes.length < 2) return;
    context.globalAlpha = 0.14;
    context.beginPath();
    for (const choose of [Math.max, Math.min]) {
      for (let n = 0; n < POINTS; n++) {
        const i = choose === Math.max ? n : POINTS - 1 - n;
        context.lineTo(along[i], across(shapes.reduce((end, shape) => choose(end, shape[i]), 0)));
      }
    }
    context.fill();
    context.globalAlpha = 1;
  }
}

/** The places of a shape's points. @param {[number, number][]} knots */
function placesOf(knots) {
  const end = knots[knots.length - 1][0];
  return Array.from({ length: POINTS }, (_, i) => {
    const x = (i / (POINTS - 1)) * end;
    const at = Math.max(
      knots.findIndex(([knot]) => knot >= x),
      1,
    );
    const [[x0, p0], [x1, p1]] = [knots[at - 1], knots[at]];
    return p0 + ((x - x0) / (x1 - x0 || 1)) * (p1 - p0);
  });
}
