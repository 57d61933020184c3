/** The bow's area: the hair that passes under the finger, and how firm it is; or the whole bow. */

/** @typedef {import('../hands/bow.js').Bow} Bow */
/** @typedef {import('./picture.js').Moment} Moment */

import { translate } from "../i18n.js";
import { Picture, font } from "./picture.js";

const GAP = 1 / 24; // between marks on the hair, in widths of the area
const THIN = 4;
const THICK = 26; // px, of the hair from light to firm
// The whole bow, that the instrument draws, with the frog at the right; the string is in the middle.
const ROOM = 0.92; // of the area's width, for all ways of the bow
const SPACING = 0.03; // m between marks on the hair
const NEAR_END = 0.06; // of the hair
const STICK = 0.1; // of the area's height, above the hair
const STRINGS = /** @type {const} */ (["inner", "outer"]);

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
    if (!isByHand && bow.by === null && state && state.hair.length > 0) {
      this.#sides(context);
      this.#whole(context, state, isCalm);
      return;
    }
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
   * The whole bow, with the string at its place on the hair.
   * @param {CanvasRenderingContext2D} context
   * @param {import('../interfaces.js').Snapshot} state
   * @param {boolean} isCalm the bow rests, and the string goes along it
   */
  #whole(context, { bow, hair }, isCalm) {
    const { colours, width, height } = this;
    const scale = (ROOM * width) / (2 * hair.length); // px for a metre
    const place = Math.min(Math.max(hair.place, 0), hair.length);
    const frog = width / 2 + (isCalm ? hair.length / 2 : place) * scale;
    const string = frog - place * scale;
    const tip = frog - hair.length * scale;
    const stick = Math.min(Math.max(STICK * height, 12), 32);
    const y = (height + stick) / 2;
    const isOn = bow.string >= 0;
    const thick = 0.35 * stick;
    context.globalAlpha = isOn ? 1 : 0.4;
    context.strokeStyle = colours.soft;
    context.lineCap = "round";
    context.lineWidth = 3;
    context.beginPath();
    context.moveTo(tip, y);
    context.quadraticCurveTo(
      tip + 0.05 * (frog - tip),
      y - stick,
      tip + 0.2 * (frog - tip),
      y - stick,
    );
    context.lineTo(frog + 10, y - stick);
    context.stroke();
    context.fillStyle = colours.glow;
    context.fillRect(tip, y - thick / 2, frog - tip, thick);
    context.fillStyle = colours.ink;
    context.beginPath();
    context.roundRect(frog - 2, y - stick, 12, stick + thick / 2 + 1, 3);
    context.fill();
    context.strokeStyle = colours.soft;
    context.lineWidth = 1;
    context.beginPath();
    for (let x = SPACING; x < hair.length; x += SPACING) {
      context.moveTo(frog - x * scale - 1.5, y + thick / 2);
      context.lineTo(frog - x * scale + 1.5, y - thick / 2);
    }
    context.stroke();
    const left = Math.min(place, hair.length - place) / hair.length;
    context.fillStyle = bow.string === -1 ? colours.soft : colours[STRINGS[bow.string]];
    context.fillRect(string - 1.5, y - 2 * stick, 3, 3.5 * stick);
    if (isOn && left < NEAR_END) context.fillStyle = colours.bad; // the bow turns soon
    context.beginPath();
    context.arc(string, y, 0.25 * stick + 2, 0, 2 * Math.PI);
    context.fill();
    context.globalAlpha = 1;
    context.font = font(12);
    context.fillStyle = colours.soft;
    context.textAlign = "center";
    context.textBaseline = "top";
    context.fillText(translate("bow.tip"), Math.max(tip, 24), y + stick);
    context.fillText(translate("bow.frog"), Math.min(frog, width - 24), y + stick);
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
    context.fillText(translate("bow.light"), 12, 9);
    context.textBaseline = "bottom";
    context.fillText(translate("bow.firm"), 12, this.height - 8);
    context.textAlign = "right";
    context.fillText(translate("bow.draw"), this.width - 12, this.height - 8);
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
