/** The fingerboard: its notes, the fingers on it, and what sounds. */

/** @typedef {import("../hands/fingerboard.js").Fingerboard} Fingerboard */
/** @typedef {import("./picture.js").Moment} Moment */

import { HIGHEST, LOWEST, OPEN, isNatural, nameOf } from "../hands/scale.js";
import { translate } from "../i18n.js";
import { Picture, font } from "./picture.js";
import { soundingPitch } from "./regime.js";

const SAME = 0.01; // semitones
const FINGER = 17; // px, radius of the finger that stops the string
const OTHER = 12; // and of those that wait

export class Board extends Picture {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Fingerboard} fingerboard
   */
  constructor(canvas, fingerboard) {
    super(canvas);
    this.fingerboard = fingerboard;
    /** @type {number | null} a note that should be played next */
    this.next = null;
    const renew = () => {
      this.isStale = true;
    };
    fingerboard.addEventListener("change", renew);
    fingerboard.hands.addEventListener("change", renew);
  }

  /** @param {number | null} pitch to be played next */
  mark(pitch) {
    this.next = pitch;
    this.isStale = true;
    this.fingerboard.bring(pitch);
  }

  get isAcross() {
    return this.fingerboard.direction === "across";
  }

  /** Room beside the scale, px. */
  get room() {
    return this.isAcross ? this.height : this.width;
  }

  /**
   * A point of the board.
   * @param {number} pitch along the scale
   * @param {number} beside px, across it
   * @returns {[number, number]}
   */
  #at(pitch, beside) {
    const along = this.fingerboard.scale.placeOf(pitch);
    return this.isAcross ? [along, beside] : [beside, along];
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Moment} moment
   */
  draw(context, { state }) {
    const { scale, tuned, hands } = this.fingerboard;
    const first = Math.max(Math.ceil(scale.pitchAt(0)), LOWEST);
    const last = Math.min(Math.floor(scale.pitchAt(scale.length)), HIGHEST);
    for (let note = first; note <= last; note++) this.#line(context, note);
    for (let note = first; note <= last; note++) this.#name(context, note);
    for (const pitch of tuned.pitches) {
      // Where a finger lands in another tuning than the keyboard's.
      if (Math.abs(pitch - Math.round(pitch)) > SAME) this.#disc(context, pitch, 4, 0.5);
    }
    for (const { pitch } of hands.fingers) {
      if (pitch === hands.top?.pitch) this.#disc(context, pitch, FINGER, 0.9);
      else this.#disc(context, pitch, OTHER, 0.3);
    }
    if (this.next !== null) this.#ring(context, this.next);
    const pitch = state ? soundingPitch(state) : NaN;
    if (!Number.isNaN(pitch)) this.#sounding(context, pitch);
  }

  /** @param {number} note */
  #colourOf(note) {
    const open = OPEN.indexOf(note);
    return open < 0 ? null : this.colours[open ? "outer" : "inner"];
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {number} note
   */
  #line(context, note) {
    const open = this.#colourOf(note);
    const natural = isNatural(note);
    context.strokeStyle = open ?? this.colours.line;
    context.lineWidth = open ? 3 : natural ? 1.5 : 1;
    context.globalAlpha = natural ? 1 : 0.7;
    context.beginPath();
    context.moveTo(...this.#at(note, natural ? 0 : this.room * 0.36));
    context.lineTo(...this.#at(note, natural ? this.room : this.room * 0.64));
    context.stroke();
    context.globalAlpha = 1;
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {number} note
   */
  #name(context, note) {
    if (!isNatural(note)) return;
    const open = this.#colourOf(note);
    const openName = translate(`board.open${OPEN.indexOf(note)}`);
    context.textBaseline = "middle";
    context.font = font(13, open ? 700 : 400);
    if (this.isAcross) this.#write(context, nameOf(note), note, this.room - 14, open, true);
    else this.#write(context, open ? openName : nameOf(note), note, 8, open, false);
    if (!open || !this.isAcross) return;
    // Below the buttons for other notes, if there are any.
    const beside = this.fingerboard.scale.isPart ? 52 : 16;
    context.font = font(12);
    const [x, y] = this.#at(note, beside);
    context.textAlign = "left";
    context.fillStyle = this.colours.surface;
    context.fillRect(x + 4, y - 9, context.measureText(openName).width + 6, 18);
    context.fillStyle = open;
    context.fillText(openName, x + 7, y);
  }

  /**
   * Write on a plate, so that no line runs through it.
   * @param {CanvasRenderingContext2D} context
   * @param {string} text
   * @param {number} note
   * @param {number} beside
   * @param {string | null} colour
   * @param {boolean} isCentred
   */
  #write(context, text, note, beside, colour, isCentred) {
    const [x, y] = this.#at(note, beside);
    const wide = context.measureText(text).width + 6;
    context.fillStyle = this.colours.surface;
    context.fillRect(isCentred ? x - wide / 2 : x - 3, y - 9, wide, 18);
    context.textAlign = isCentred ? "center" : "left";
    context.fillStyle = colour ?? this.colours.soft;
    context.fillText(text, x, y);
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {number} pitch
   * @param {number} radius
   * @param {number} alpha
   */
  #disc(context, pitch, radius, alpha) {
    context.globalAlpha = alpha;
    context.fillStyle = this.colours.accent;
    context.beginPath();
    context.arc(...this.#at(pitch, this.room / 2), radius, 0, 2 * Math.PI);
    context.fill();
    context.globalAlpha = 1;
  }

  /**
   * The note to be played next.
   * @param {CanvasRenderingContext2D} context
   * @param {number} pitch
   */
  #ring(context, pitch) {
    context.strokeStyle = this.colours.accent;
    context.lineWidth = 3;
    context.beginPath();
    context.arc(...this.#at(pitch, this.room / 2), FINGER + 4, 0, 2 * Math.PI);
    context.stroke();
  }

  /**
   * What is heard, wherever the finger may be.
   * @param {CanvasRenderingContext2D} context
   * @param {number} pitch
   */
  #sounding(context, pitch) {
    const [from, to] = this.isAcross ? [0.08, 0.8] : [0.22, 0.92]; // not through the names
    context.strokeStyle = this.colours.ink;
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(...this.#at(pitch, this.room * from));
    context.lineTo(...this.#at(pitch, this.room * to));
    context.stroke();
  }
}
