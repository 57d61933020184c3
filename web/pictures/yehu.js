/** The instrument, as it is played: strings, fingers and bow on neck and coconut. */

/** @typedef {import("../interfaces.js").Snapshot} Snapshot */
/** @typedef {import("./picture.js").Moment} Moment */
/** @typedef {import("../hands/fingerboard.js").Fingerboard} Fingerboard */
/** @typedef {'slowed' | 'moving' | 'still'} View */

import { LOWEST, OPEN } from "../hands/scale.js";
import { translate } from "../i18n.js";
import { POINTS } from "../sound/snapshot.js";
import { drawBow, drawForces } from "./bow.js";
import { Picture, font } from "./picture.js";
import { soundingPitch } from "./regime.js";
import { RestShape } from "./rest_shape.js";
import { Stroboscope } from "./stroboscope.js";
import { Wood, disc, laneOf, writeNotes } from "./wood.js";

const STRINGS = /** @type {const} */ (["inner", "outer"]);
/** Periods a second in the slowed view. */
const SLOW = 0.4;
/** A swing that is smaller, in m, is not drawn larger. */
const LEAST_SWING = 0.15e-3;
const SWING = 0.15; // of the breadth, for the greatest swing of a note
const MOST_SWING = 80; // px
const TRAIL = 10; // shapes that are still seen, in the view of all
const QUIET = -55; // dBFS; from here on a string glows
const LOUD = -15;
const SILENT = -60;
const FINGER = 15; // px
const SAME = 0.01; // semitones

export class Yehu extends Picture {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Fingerboard} fingerboard
   * @param {import('../hands/bow.js').Bow} bow
   */
  constructor(canvas, fingerboard, bow) {
    super(canvas);
    this.fingerboard = fingerboard;
    this.surface = fingerboard.surface;
    this.bow = bow;
    /** @type {View} still: the room in which they move, and no motion */
    this.view = "slowed";
    /** The computer's keys, by note, once they are played. @type {Map<number, string>} */
    this.keys = new Map();
    /** A note that should be played next. @type {number | null} */
    this.next = null;
    this.slow = [new Stroboscope(), new Stroboscope()];
    this.rests = [new RestShape(), new RestShape()];
    /** @type {[Float32Array[], Float32Array[]]} the latest shapes, the last one last */
    this.trails = [[], []];
    this.swing = LEAST_SWING;
    this.phase = 0;
    this.string = 0; // the one that was bowed last
    this.backdrop = document.createElement("canvas");
    const renew = () => {
      this.isStale = true;
    };
    fingerboard.addEventListener("change", renew);
    const follow = () => this.wake();
    fingerboard.hands.addEventListener("change", follow);
  }

  /** @param {number | null} pitch to be played next */
  mark(pitch) {
    this.next = pitch;
    this.isStale = true;
    this.fingerboard.bring(pitch);
  }

  get isWanted() {
    return this.view !== "still";
  }

  /** It is played at the same places, however large it is. */
  get isMagnified() {
    return false;
  }

  /** @param {Moment} moment */
  notice({ state, isNew }) {
    if (!state || !isNew) return;
    this.#collect(state);
    // Whoever else plays is seen where the board goes on.
    if (state.bow.string >= 0 && state.pitch >= LOWEST)
      this.fingerboard.show(Math.round(state.pitch));
  }

  /** @param {Snapshot} state */
  #collect(state) {
    if (state.bow.string >= 0) this.string = state.bow.string;
    for (const string of /** @type {const} */ ([0, 1])) {
      const shape = this.rests[string].without(state.shape[string], state);
      if (this.rests[string].isNew) {
        this.slow[string].clear();
        this.trails[string].length = 0;
        if (string === state.bow.string) this.swing = LEAST_SWING; // another note has its own scale
      }
      if (!this.rests[string].isSettled) continue;
      if (string === state.bow.string) {
        for (const y of shape) this.swing = Math.max(this.swing, Math.abs(y));
      }
      this.slow[string].add(shape, state.time, state.period);
      this.trails[string].push(shape);
      if (this.trails[string].length > TRAIL) this.trails[string].shift();
    }
  }

  /** Along and across the strings from here on. */
  #lie() {
    if (this.surface.isUpright) this.context.transform(0, 1, 1, 0, 0, 0);
  }

  /**
   * Write upright, whichever way the instrument lies.
   * @param {string} text
   * @param {number} along
   * @param {number} across
   */
  #write(text, along, across) {
    const [x, y] = this.surface.isUpright ? [across, along] : [along, across];
    this.context.fillText(text, x, y);
  }

  /** What stands still. */
  fitted() {
    const { canvas, backdrop, context, surface, fingerboard } = this;
    Object.assign(backdrop, { width: canvas.width, height: canvas.height });
    const behind = /** @type {CanvasRenderingContext2D} */ (backdrop.getContext("2d"));
    behind.setTransform(context.getTransform());
    this.context = behind;
    behind.save();
    this.#lie();
    const wood = new Wood(behind, surface, this.colours);
    wood.drawField();
    wood.drawNotes(fingerboard.scale);
    wood.drawNeck();
    wood.drawCoconut();
    wood.drawLoop(fingerboard.scale);
    for (const pitch of fingerboard.tuned.pitches) {
      // Where a finger lands in another tuning than the keyboard's.
      if (Math.abs(pitch - Math.round(pitch)) > SAME) {
        disc(behind, this.#placeOf(pitch), surface.breadth / 2, 4, this.colours.ink);
      }
    }
    behind.restore();
    const write = this.#write.bind(this);
    writeNotes(write, behind, surface, fingerboard.scale, this.colours, this.keys);
    this.context = context;
  }

  /** @param {number} pitch */
  #placeOf(pitch) {
    return this.surface.board[0] + this.fingerboard.scale.placeOf(pitch);
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Moment} moment
   */
  draw(context, { state, elapsed, isCalm }) {
    const { surface, bow, colours } = this;
    if (this.view === "slowed") this.phase += SLOW * elapsed;
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.backdrop, 0, 0);
    context.restore();
    context.save();
    this.#lie();
    if (bow.hands.isBowing) drawForces(context, surface, bow, colours);
    const knots = this.#knots(state);
    for (const string of [0, 1]) this.#string(context, string, state, knots);
    if (state) for (const finger of state.fingers) this.#finger(context, state, finger);
    this.#touches(context);
    if (this.next !== null) this.#ring(context, this.next);
    drawBow(context, surface, bow, colours, state, isCalm);
    context.restore();
    const pitch = state ? soundingPitch(state) : NaN;
    if (!Number.isNaN(pitch) && state && state.bow.string >= 0) this.#sounding(context, pitch);
    if (bow.hands.isBowing) this.#numbers(context);
  }

  /**
   * Places on the string (m) and on the picture (px): the same note is always at one place, and so is
   * the bow.
   * @param {Snapshot | null} state
   * @returns {[number, number][]}
   */
  #knots(state) {
    const { bridge } = this.surface;
    const start = this.#placeOf(OPEN[0]);
    if (!state) return [[0, start], [1, bridge]]; // prettier-ignore
    const { length } = state.string;
    const stop = state.fingers.reduce((farthest, { x }) => Math.max(farthest, x), 0);
    /** @type {[number, number][]} */
    const knots = [[0, start]];
    if (stop > 0) knots.push([stop, this.#placeOfFinger(state, stop)]);
    if (state.bow.string >= 0 && state.bow.x > stop) {
      knots.push([state.bow.x, this.surface.bowAt(state.bow.beta)]);
    }
    return [...knots, [length, bridge]];
  }

  /**
   * @param {Snapshot} state
   * @param {number} x m
   */
  #placeOfFinger({ string: { length } }, x) {
    return this.#placeOf(OPEN[this.string] - 12 * Math.log2(1 - Math.min(x / length, 0.98)));
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {number} string
   * @param {Snapshot | null} state
   * @param {[number, number][]} knots
   */
  #string(context, string, state, knots) {
    const { surface, colours, view } = this;
    const lane = laneOf(surface, string);
    const along = placesOf(knots);
    const side = surface.isUpright ? 1 : -1;
    const gain = (side * Math.min(SWING * surface.breadth, MOST_SWING)) / this.swing;
    const trail = this.trails[string];
    const colour = colours[STRINGS[string]];
    context.strokeStyle = colour;
    context.lineCap = context.lineJoin = "round";
    context.lineWidth = 1.5;
    context.beginPath(); // to its peg
    context.moveTo(surface.board[0] * (string ? 0.34 : 0.68), lane);
    context.lineTo(along[0], lane);
    context.stroke();
    const level = state?.level ?? SILENT;
    // Else it only gives way to a finger that sways.
    const isHeard = level > SILENT && string === this.string;
    if (isHeard) this.#envelope(context, string, lane, along, gain);
    const line = (/** @type {Float32Array} */ shape, /** @type {number} */ width) => {
      context.lineWidth = width;
      context.beginPath();
      for (let i = 0; i < POINTS; i++) context.lineTo(along[i], lane + gain * shape[i]);
      context.stroke();
    };
    /** @type {Float32Array} */
    let shape = new Float32Array(POINTS);
    if (isHeard && view === "slowed" && this.slow[string].known > 0) {
      shape = this.slow[string].at(this.phase);
    } else if (isHeard && view === "moving" && trail.length) shape = trail[trail.length - 1];
    const glow = isHeard ? Math.min(Math.max((level - QUIET) / (LOUD - QUIET), 0), 1) : 0;
    for (const width of glow > 0 ? [16, 9, 5] : []) {
      context.globalAlpha = 0.16 * glow;
      line(shape, width);
    }
    if (view === "moving") {
      trail.slice(0, -1).forEach((one, i) => {
        context.globalAlpha = (0.3 * (i + 1)) / TRAIL;
        line(one, 1);
      });
    }
    context.globalAlpha = 1;
    line(shape, 2.2);
  }

  /**
   * The room in which the string has moved of late.
   * @param {CanvasRenderingContext2D} context
   * @param {number} string
   * @param {number} lane
   * @param {number[]} along
   * @param {number} gain
   */
  #envelope(context, string, lane, along, gain) {
    const known = this.slow[string].bins.filter((_, bin) => this.slow[string].isKnown(bin));
    const shapes = [...this.trails[string], ...known];
    if (shapes.length < 2) return;
    context.globalAlpha = 0.14;
    context.fillStyle = this.colours[STRINGS[string]];
    context.beginPath();
    for (const [choose, order] of /** @type {const} */ ([
      [Math.max, 1],
      [Math.min, -1],
    ])) {
      for (let n = 0; n < POINTS; n++) {
        const i = order > 0 ? n : POINTS - 1 - n;
        const end = shapes.reduce((found, shape) => choose(found, shape[i]), 0);
        context.lineTo(along[i], lane + gain * end);
      }
    }
    context.fill();
    context.globalAlpha = 1;
  }

  /**
   * A finger stops both strings at once.
   * @param {CanvasRenderingContext2D} context
   * @param {Snapshot} state
   * @param {{x: number, press: number}} finger
   */
  #finger(context, state, { x, press }) {
    const place = this.#placeOfFinger(state, x);
    const colour = this.colours[STRINGS[this.string]];
    disc(context, place, laneOf(this.surface, this.string), FINGER + Math.min(press, 4), colour);
    disc(context, place, laneOf(this.surface, this.string), FINGER - 6, this.colours.surface);
  }

  /** Where hands touch: how loud. @param {CanvasRenderingContext2D} context */
  #touches(context) {
    const { surface, fingerboard } = this;
    for (const { id, pitch } of fingerboard.hands.fingers) {
      const loud = fingerboard.touches.get(Number(id))?.loud;
      const along = this.#placeOf(pitch);
      const lane = laneOf(surface, pitch >= OPEN[1] ? 1 : 0);
      const across = loud === undefined ? lane : surface.loudnessAt(loud);
      const isTop = id === fingerboard.hands.top?.id;
      context.globalAlpha = isTop ? 0.5 : 0.2;
      context.strokeStyle = this.colours[STRINGS[pitch >= OPEN[1] ? 1 : 0]];
      context.lineWidth = 3;
      context.beginPath();
      context.moveTo(along, lane);
      context.lineTo(along, across);
      context.stroke();
      disc(context, along, across, isTop ? 22 : 14, context.strokeStyle);
      context.globalAlpha = 1;
    }
  }

  /**
   * The note to be played next.
   * @param {CanvasRenderingContext2D} context
   * @param {number} pitch
   */
  #ring(context, pitch) {
    context.strokeStyle = this.colours.accent;
    context.lineWidth = 4;
    context.beginPath();
    context.arc(this.#placeOf(pitch), this.surface.breadth / 2, FINGER + 10, 0, 2 * Math.PI);
    context.stroke();
  }

  /**
   * What is heard, wherever the finger may be: a mark at the loud side.
   * @param {CanvasRenderingContext2D} context
   * @param {number} pitch
   */
  #sounding(context, pitch) {
    const { surface, colours } = this;
    context.save();
    this.#lie();
    const tip = surface.loudnessAt(1) + (surface.isUpright ? -38 : 38);
    const end = tip + (surface.isUpright ? 14 : -14);
    const along = this.#placeOf(pitch);
    context.fillStyle = colours.ink;
    context.beginPath();
    context.moveTo(along, tip);
    context.lineTo(along - 6, end);
    context.lineTo(along + 6, end);
    context.fill();
    context.restore();
  }

  /** How fast and firm the hand draws. @param {CanvasRenderingContext2D} context */
  #numbers(context) {
    const { speed, force } = this.bow.hands.stroke;
    const text = `${Math.abs(speed).toFixed(2)} m/s  ${force.toFixed(2)} N`;
    context.font = font(14, 600);
    context.fillStyle = this.colours.ink;
    context.textAlign = "left";
    context.textBaseline = "bottom";
    const left = this.surface.isUpright ? 12 : this.surface.board[1] + 10;
    context.fillText(text, left, this.height - 56);
    context.font = font(14);
    context.fillStyle = this.colours.good;
    context.fillText(translate("bow.green"), left, this.height - 76);
  }
}

/**
 * The places of a shape's points.
 * @param {[number, number][]} knots
 */
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
