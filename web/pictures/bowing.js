/** The bow's area: the hair that passes under the finger, and how firm it is. */

/** @typedef {import('../hands/bow.js').Bow} Bow */
/** @typedef {import('./picture.js').Moment} Moment */

import { say } from "../words.js";
import { Picture, font } from "./picture.js";

const GAP = 1 / 24; // between marks on the hair, in widths of the area
const THIN = 4;
const THICK = 26; // px, of the hair from light to firm

export class Bowing extends Picture {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Bow} bow
   */
  constructor(canvas, bow) {
    super(canvas);
    this.bow = bow;
    this.hair = 0;
    bow.hands.addEventListener("change", () => {
      this.isStale = true;
    });
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Moment} moment
   */
  draw(context, { state, elapsed, isCalm }) {
    const { bow, width, height } = this;
    const isByHand = bow.hands.isBowing;
    if (!isByHand && state && state.bow.string >= 0) {
      bow.hair += (state.bow.speed * elapsed) / 0.55; // the instrument draws: its hair is seen too
    }
    const y =
      Math.min(Math.max(isByHand || bow.by !== null ? bow.height : 0.5, 0.06), 0.94) * height;
    const thick = THIN + (THICK - THIN) * bow.height;
    if (isByHand) this.#wedge(context);
    this.#sides(context);
    context.globalAlpha = isByHand ? 1 : 0.55;
    context.fillStyle = this.colours.glow;
    context.fillRect(0, y - thick / 2, width, thick);
    context.strokeStyle = this.colours.soft;
    context.lineWidth = 1;
    const shift = isCalm ? 0 : ((bow.hair % GAP) + GAP) % GAP;
    for (let x = shift - GAP; x < 1 + GAP; x += GAP) {
      context.beginPath();
      context.moveTo(x * width - 3, y + thick / 2);
      context.lineTo(x * width + 3, y - thick / 2);
      context.stroke();
    }
    context.globalAlpha = 1;
    if (isByHand) this.#numbers(context, y, thick);
  }

  /**
   * Where the string sounds well: the wedge of Schelleng's diagram, at the present place.
   * @param {CanvasRenderingContext2D} context
   */
  #wedge(context) {
    const heights = this.bow.playable;
    if (!heights) return;
    const [top, bottom] = heights.map((height) => height * this.height);
    context.globalAlpha = 0.09;
    context.fillStyle = this.colours.good;
    context.fillRect(0, top, this.width, bottom - top);
    context.globalAlpha = 0.5;
    if (top > 0) context.fillRect(0, top, this.width, 1);
    if (bottom < this.height) context.fillRect(0, bottom, this.width, 1);
    context.globalAlpha = 1;
  }

  /** @param {CanvasRenderingContext2D} context */
  #sides(context) {
    context.fillStyle = this.colours.soft;
    context.font = font(12);
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillText(say("bow.light"), 12, 9);
    context.textBaseline = "bottom";
    context.fillText(say("bow.firm"), 12, this.height - 8);
    context.textAlign = "right";
    context.fillText(say("bow.draw"), this.width - 12, this.height - 8);
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {number} y
   * @param {number} thick
   */
  #numbers(context, y, thick) {
    const { speed, force } = this.bow.hands.stroke;
    context.font = font(13, 600);
    context.fillStyle = this.colours.ink;
    context.textAlign = "center";
    const below = y < this.height / 2;
    context.textBaseline = below ? "top" : "bottom";
    const text = `${Math.abs(speed).toFixed(2)} m/s   ${force.toFixed(2)} N`;
    context.fillText(text, this.width / 2, y + (below ? 1 : -1) * (thick / 2 + 6));
  }
}
