/** The instrument, as it is played: strings, fingers and bow on neck and coconut. */

/** @typedef {import("../interfaces.js").Snapshot} Snapshot */
/** @typedef {import("./picture.js").Moment} Moment */
/** @typedef {import("../hands/fingerboard.js").Fingerboard} Fingerboard */
/** @typedef {import("./targets.js").Targets} Targets */

import { LOWEST, OPEN, fingerOf, stringOf } from "../hands/scale.js";
import { translate } from "../i18n.js";
import { drawBow, drawForces } from "./bow.js";
import { Picture, disc, fill, font, line } from "./picture.js";
import { soundingPitch } from "../sound/snapshot.js";
import { STRINGS, Strings } from "./strings.js";
import { drawTargets } from "./targets.js";
import { Wood, laneOf, writeNotes } from "./wood.js";

const FINGER = 15; // px
const SAME = 0.01; // semitones
const MIN_FOR_NUMBERS = 420; // px; lower, they would lie over the coconut

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
    this.strings = new Strings();
    /** The computer's keys, by note, once they are played. @type {Map<number, string>} */
    this.keys = new Map();
    /** What a tune asks for. @type {Targets | null} */
    this.targets = null;
    this.showsFingers = false; // which finger stops a note
    this.backdrop = document.createElement("canvas");
    fingerboard.addEventListener("change", () => (this.isStale = true));
    fingerboard.hands.addEventListener("change", () => this.wake());
  }

  /** Put a ring around a note, or none. @param {number | null} pitch */
  ask(pitch) {
    const still = { repeats: 1, due: null, asked: 0, isAgain: false, wrong: null };
    this.targets = pitch === null ? null : { pitches: [pitch], ...still };
    this.isStale = true;
  }

  get isWanted() {
    return this.strings.view !== "still";
  }

  /** It is played at the same places, however large it is. */
  get isMagnified() {
    return false;
  }

  /** @param {Moment} moment */
  notice({ state, isNew }) {
    if (!state || !isNew) return;
    this.strings.collect(state);
    // Whoever else plays is seen where the board goes on.
    if (state.bow.string >= 0 && state.pitch >= LOWEST)
      this.fingerboard.show(Math.round(state.pitch));
  }

  /** Along and across the strings from here on. */
  #lie() {
    if (this.surface.isUpright) this.context.transform(0, 1, 1, 0, 0, 0);
  }

  /** Write upright, whichever way the instrument lies. */
  write = (
    /** @type {string} */ text,
    /** @type {number} */ along,
    /** @type {number} */ across,
  ) => {
    if (this.surface.isUpright) this.context.fillText(text, across, along);
    else this.context.fillText(text, along, across);
  };

  /** The parts that do not move. */
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
        disc(behind, this.placeOf(pitch), surface.breadth / 2, 4, this.colours.ink);
      }
    }
    behind.restore();
    writeNotes(this);
    this.context = context;
  }

  /** @param {number} pitch */
  placeOf(pitch) {
    return this.surface.board[0] + this.fingerboard.scale.placeOf(pitch);
  }

  /** @param {Moment} moment */
  draw(moment) {
    const { context, bow, strings } = this;
    const { state } = moment;
    strings.go(moment.elapsed);
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.backdrop, 0, 0);
    context.restore();
    context.save();
    this.#lie();
    if (bow.hands.isBowing) drawForces(this);
    strings.draw(this, state?.level ?? -Infinity, this.#knots(state));
    for (const { x, press } of state?.fingers ?? []) this.#finger(this.#placeOfFinger(x), press);
    const isBowed = (state?.bow.string ?? -1) >= 0;
    this.#touches(isBowed);
    drawBow(this, state, moment.isCalm);
    if (this.targets && drawTargets(this, this.targets, moment)) this.wake();
    const pitch = state ? soundingPitch(state) : NaN;
    if (isBowed && !Number.isNaN(pitch)) this.#sounding(pitch);
    context.restore();
    this.#words(state);
    if (bow.hands.isBowing && this.height > MIN_FOR_NUMBERS) this.#numbers();
  }

  /**
   * Places on the string (m) and on the picture (px): the same note is always at one place, and so is
   * the bow.
   * @param {Snapshot | null} state
   * @returns {[number, number][]}
   */
  #knots(state) {
    const { bridge } = this.surface;
    const start = this.placeOf(OPEN[0]);
    if (!state) return [[0, start], [1, bridge]]; // prettier-ignore
    const { length } = state.string;
    this.length = length;
    const stop = state.fingers.reduce((farthest, { x }) => Math.max(farthest, x), 0);
    /** @type {[number, number][]} */
    const knots = [[0, start]];
    if (stop > 0) knots.push([stop, this.#placeOfFinger(stop)]);
    if (state.bow.string >= 0 && state.bow.x > stop) {
      knots.push([state.bow.x, this.surface.bowAt(state.bow.beta)]);
    }
    return [...knots, [length, bridge]];
  }

  length = 1; // m, of the strings

  /** @param {number} x m */
  #pitchAt(x) {
    return OPEN[this.strings.bowed] - 12 * Math.log2(1 - Math.min(x / this.length, 0.98));
  }

  /** @param {number} x m */
  #placeOfFinger(x) {
    return this.placeOf(this.#pitchAt(x));
  }

  /**
   * A finger stops both strings at once.
   * @param {number} place px
   * @param {number} press N
   */
  #finger(place, press) {
    const { context, surface, colours, strings } = this;
    const lane = laneOf(surface, strings.bowed);
    disc(context, place, lane, FINGER + Math.min(press, 4), colours[STRINGS[strings.bowed]]);
    disc(context, place, lane, FINGER - (this.showsFingers ? 3 : 6), colours.surface);
  }

  /** Where hands touch: how loud. @param {boolean} isBowed */
  #touches(isBowed) {
    const { context, surface, fingerboard } = this;
    for (const { id, pitch } of fingerboard.hands.fingers) {
      const loud = fingerboard.touches.get(Number(id))?.loud;
      const along = this.placeOf(pitch);
      const isTop = id === fingerboard.hands.top?.id;
      const string = isTop && isBowed ? this.strings.bowed : stringOf(pitch);
      const lane = laneOf(surface, string);
      const across = loud === undefined ? lane : surface.loudnessAt(loud);
      context.globalAlpha = isTop ? 0.5 : 0.2;
      context.strokeStyle = this.colours[STRINGS[string]];
      context.lineWidth = 3;
      line(context, [along, lane], [along, across]);
      disc(context, along, across, isTop ? 22 : 14, context.strokeStyle);
      context.globalAlpha = 1;
    }
  }

  /** What is heard, wherever the finger may be: a mark at the loud side. @param {number} pitch */
  #sounding(pitch) {
    const { context, surface, colours } = this;
    const tip = surface.loudnessAt(1) + (surface.isUpright ? -38 : 38);
    const end = tip + (surface.isUpright ? 14 : -14);
    const along = this.placeOf(pitch);
    context.fillStyle = colours.ink;
    fill(context, [along, tip], [along - 6, end], [along + 6, end]);
  }

  /** Numbers of fingers, and how often a note comes. @param {Snapshot | null} state */
  #words(state) {
    const { context, surface, targets, colours, strings } = this;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.font = font(15, 700);
    context.fillStyle = colours.ink;
    const lane = laneOf(surface, strings.bowed);
    for (const { x } of (this.showsFingers && state?.fingers) || []) {
      const finger = fingerOf(this.#pitchAt(x), strings.bowed);
      this.write(String(finger), this.#placeOfFinger(x), lane);
    }
    if (!targets || targets.repeats < 2) return;
    context.fillStyle = colours.accent;
    const beside = surface.breadth / 2 - 46;
    this.write(`×${targets.repeats}`, this.placeOf(targets.pitches[0]), beside);
  }

  /** How fast and firm the hand draws. */
  #numbers() {
    const { context, colours, surface, height } = this;
    const { speed, force } = this.bow.hands.stroke;
    const numbers = `${Math.abs(speed).toFixed(2)} m/s  ${force.toFixed(2)} N`;
    const left = surface.isUpright ? 8 : surface.board[1] + 8;
    const green = translate("bow.green");
    context.font = font(14, 600);
    const wide = Math.max(context.measureText(green).width, context.measureText(numbers).width);
    context.fillStyle = colours.surface;
    context.beginPath();
    context.roundRect(left, height - 54, wide + 20, 46, 8);
    context.fill();
    context.textAlign = "left";
    context.textBaseline = "bottom";
    context.fillStyle = colours.good;
    context.fillText(green, left + 10, height - 32);
    context.fillStyle = colours.ink;
    context.fillText(numbers, left + 10, height - 12);
  }
}
