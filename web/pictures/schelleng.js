/**
 * Schelleng's diagram, live: bow force against bow position. Between the least and the greatest
 * force the string moves in Helmholtz motion; the dot is where the bow is now.
 */

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */
/** @typedef {import('./picture.js').Moment} Moment */

import { translate } from "../i18n.js";
import { Limits } from "./limits.js";
import { Picture, font } from "./picture.js";
import { regimeOf } from "./regime.js";

const NEAREST = 0.035; // beta, at the left
const FARTHEST = 0.5;
const LIGHTEST = 0.02; // N
const FIRMEST = 10;
const BETAS = [0.05, 0.1, 0.2, 0.4];
const FORCES = [0.03, 0.1, 0.3, 1, 3];
const TRAIL = 90; // places of the bow that are still seen
const WIDE = 0.38; // beta where the wedge is wide enough for its name
const LEFT = 34;
const RIGHT = 6;
const BOTTOM = 34;
const COLOURS = /** @type {const} */ ({
  silent: "faint",
  ringing: "faint",
  helmholtz: "good",
  slipping: "bad",
  raucous: "bad",
  settling: "soft",
  unheard: "soft",
});

export class Schelleng extends Picture {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    super(canvas);
    /** @type {{beta: number, force: number}[]} */
    this.trail = [];
    this.string = -1;
    this.limits = new Limits();
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Moment} moment
   */
  draw(context, { state, elapsed }) {
    if (state) this.#follow(state, elapsed);
    context.save();
    context.beginPath();
    context.rect(LEFT, 0, this.width - LEFT, this.height - BOTTOM);
    context.clip();
    this.#wedge(context);
    context.restore();
    this.#frame(context);
    this.#names(context);
    if (state && state.bow.string >= 0 && Math.abs(state.bow.force) > 0) this.#dot(context, state);
  }

  /**
   * @param {Snapshot} state
   * @param {number} elapsed s
   */
  #follow(state, elapsed) {
    const { bow } = state;
    this.limits.follow(state, elapsed);
    const force = Math.abs(bow.force);
    if (bow.string !== this.string || force < LIGHTEST)
      this.trail.length = 0; // another stroke
    else this.trail.push({ beta: bow.beta, force });
    this.string = bow.string;
    if (this.trail.length > TRAIL) this.trail.shift();
  }

  /** @param {number} beta */
  #across(beta) {
    return (
      LEFT + (Math.log(beta / NEAREST) / Math.log(FARTHEST / NEAREST)) * (this.width - LEFT - RIGHT)
    );
  }

  /** @param {number} force N */
  #down(force) {
    const within = Math.min(Math.max(force, LIGHTEST / 4), FIRMEST * 4);
    return (
      (1 - Math.log(within / LIGHTEST) / Math.log(FIRMEST / LIGHTEST)) * (this.height - BOTTOM)
    );
  }

  /**
   * The bow position and force that a point of the canvas stands for.
   * @param {number} x px
   * @param {number} y px
   */
  pointAt(x, y) {
    const zoom = this.width / this.canvas.clientWidth; // it may be large
    const across = (x * zoom - LEFT) / (this.width - LEFT - RIGHT);
    const down = (y * zoom) / (this.height - BOTTOM);
    return {
      beta: NEAREST * (FARTHEST / NEAREST) ** Math.min(Math.max(across, 0), 1),
      force: FIRMEST * (LIGHTEST / FIRMEST) ** Math.min(Math.max(down, 0), 1),
    };
  }

  /** @param {CanvasRenderingContext2D} context */
  #wedge(context) {
    const first = Math.max(Math.min(this.limits.tip, FARTHEST), NEAREST);
    context.beginPath();
    for (const beta of [first, FARTHEST]) {
      context.lineTo(this.#across(beta), this.#down(this.limits.at(beta).most));
    }
    for (const beta of [FARTHEST, first]) {
      context.lineTo(this.#across(beta), this.#down(this.limits.at(beta).least));
    }
    context.closePath();
    context.globalAlpha = 0.14;
    context.fillStyle = this.colours.good;
    context.fill();
    context.globalAlpha = 1;
    context.strokeStyle = this.colours.good;
    context.lineWidth = 1.8;
    for (const which of /** @type {const} */ (["most", "least"])) {
      context.beginPath();
      for (const beta of [NEAREST, FARTHEST]) {
        context.lineTo(this.#across(beta), this.#down(this.limits.at(beta)[which]));
      }
      context.stroke();
    }
  }

  /** @param {CanvasRenderingContext2D} context */
  #frame(context) {
    const bottom = this.height - BOTTOM;
    context.font = font(11);
    context.fillStyle = this.colours.line;
    context.fillRect(LEFT, 0, 1, bottom);
    context.fillRect(LEFT, bottom, this.width - LEFT, 1);
    context.fillStyle = this.colours.soft;
    context.textAlign = "center";
    context.textBaseline = "top";
    for (const beta of BETAS) {
      context.fillRect(this.#across(beta), bottom, 1, 4);
      context.fillText(String(beta), this.#across(beta), bottom + 6);
    }
    context.fillText(translate("schelleng.beta"), (this.width + LEFT) / 2, bottom + 20);
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const force of FORCES) {
      context.fillRect(LEFT - 4, this.#down(force), 4, 1);
      context.fillText(String(force), LEFT - 7, this.#down(force));
    }
    context.textAlign = "left";
    context.fillText(translate("schelleng.force"), LEFT + 8, 12);
  }

  /**
   * What is heard on either side of the wedge, and in it.
   * @param {CanvasRenderingContext2D} context
   */
  #names(context) {
    context.font = font(12);
    context.fillStyle = this.colours.soft;
    context.textBaseline = "middle";
    context.textAlign = "right";
    const right = this.width - 12;
    context.fillText(translate("regime.raucous"), right, 12);
    context.textAlign = "left";
    context.fillText(translate("regime.slipping"), LEFT + 12, this.height - BOTTOM - 14);
    const { least, most } = this.limits.at(WIDE);
    const y = (this.#down(least) + this.#down(most)) / 2;
    context.fillStyle = this.colours.good;
    context.textAlign = "right";
    context.fillText(translate("regime.helmholtz"), right, Math.min(y, this.height - BOTTOM - 14));
  }

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Snapshot} state
   */
  #dot(context, state) {
    const colour = this.colours[COLOURS[regimeOf(state)]];
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.globalAlpha = 0.35;
    context.beginPath();
    for (const { beta, force } of this.trail) context.lineTo(this.#across(beta), this.#down(force));
    context.stroke();
    context.globalAlpha = 1;
    context.fillStyle = colour;
    context.strokeStyle = this.colours.surface;
    context.beginPath();
    context.arc(
      this.#across(state.bow.beta),
      this.#down(Math.abs(state.bow.force)),
      8,
      0,
      2 * Math.PI,
    );
    context.fill();
    context.stroke();
  }
}
