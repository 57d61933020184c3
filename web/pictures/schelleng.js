/**
 * Schelleng's diagram, live: bow force against bow position. Between the least and the greatest
 * force the string moves in Helmholtz motion; the dot is where the bow is now.
 */

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */
/** @typedef {import('./picture.js').Moment} Moment */
/** @typedef {import('../interfaces.js').Player} Player */

import { Pointers } from "../hands/pointers.js";
import { translate } from "../i18n.js";
import { Picture, disc, fill, font, line } from "./picture.js";
import { regimeOf } from "../sound/snapshot.js";

const USUAL_BETA = 0.13;
/** N, of an ordinary stroke there. */
const USUAL_LEAST = 0.04;
const USUAL_MOST = 1.46;
const SMOOTH = 0.15; // s: they follow the bow's speed

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

  /** @param {Moment} moment */
  draw({ state, elapsed }) {
    const { context } = this;
    if (state) this.#follow(state, elapsed);
    context.save();
    context.beginPath();
    context.rect(LEFT, 0, this.width - LEFT, this.height - BOTTOM);
    context.clip();
    this.#wedge();
    context.restore();
    this.#frame();
    this.#names();
    if (state && state.bow.string >= 0 && Math.abs(state.bow.force) > 0) this.#dot(state);
  }

  /** @param {Snapshot} state @param {number} elapsed s */
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
   * The bow position and force that a point of the canvas stands for, also before it is drawn.
   * @param {number} x px
   * @param {number} y px
   */
  pointAt(x, y) {
    const { canvas, zoom } = this;
    const across = (x / zoom - LEFT) / (canvas.clientWidth / zoom - LEFT - RIGHT);
    const down = y / zoom / (canvas.clientHeight / zoom - BOTTOM);
    return {
      beta: NEAREST * (FARTHEST / NEAREST) ** Math.min(Math.max(across, 0), 1),
      force: FIRMEST * (LIGHTEST / FIRMEST) ** Math.min(Math.max(down, 0), 1),
    };
  }

  /** @param {number} beta @param {number} force N @returns {import("./picture.js").Point} */
  #at(beta, force) {
    return [this.#across(beta), this.#down(force)];
  }

  #wedge() {
    const { context, colours, limits } = this;
    const edge = (/** @type {"least" | "most"} */ which, /** @type {number[]} */ ...betas) =>
      betas.map((beta) => this.#at(beta, limits.at(beta)[which]));
    const first = Math.max(Math.min(limits.tip, FARTHEST), NEAREST);
    context.fillStyle = context.strokeStyle = colours.good;
    context.globalAlpha = 0.14;
    fill(context, ...edge("most", first, FARTHEST), ...edge("least", FARTHEST, first));
    context.globalAlpha = 1;
    context.lineWidth = 1.8;
    line(context, ...edge("most", NEAREST, FARTHEST));
    line(context, ...edge("least", NEAREST, FARTHEST));
  }

  #frame() {
    const { context } = this;
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

  /** What is heard on either side of the wedge, and in it. */
  #names() {
    const { context } = this;
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

  /** @param {Snapshot} state */
  #dot(state) {
    const { context, colours } = this;
    const colour = colours[COLOURS[regimeOf(state)]];
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.globalAlpha = 0.35;
    line(context, ...this.trail.map(({ beta, force }) => this.#at(beta, force)));
    context.globalAlpha = 1;
    const [x, y] = this.#at(state.bow.beta, Math.abs(state.bow.force));
    disc(context, x, y, 9, colours.surface);
    disc(context, x, y, 7, colour);
  }
}

/** Schelleng's limits of the bow force at every place of the bow, from those that are reported for one place. */
export class Limits {
  constructor() {
    this.beta = USUAL_BETA;
    /** Logarithms of the limits at `beta`. */
    this.least = Math.log(USUAL_LEAST);
    this.most = Math.log(USUAL_MOST);
  }

  /**
   * Follow what is reported of the bow.
   * @param {Pick<Snapshot, 'bow' | 'schelleng'>} state
   * @param {number} elapsed s
   */
  follow({ bow, schelleng: { min, max } }, elapsed) {
    if (bow.string < 0 || !(min > 0 && max > 0) || bow.speed === 0) return;
    const share = Math.min(elapsed / SMOOTH, 1);
    // Carried to where the bow is now, along their slopes, before they are averaged.
    const away = Math.log(this.beta / bow.beta);
    this.least += 2 * away;
    this.most += away;
    this.beta = bow.beta;
    this.least += share * (Math.log(min) - this.least);
    this.most += share * (Math.log(max) - this.most);
  }

  /**
   * The limits at a place (N): the least force falls with its square, the greatest with itself.
   * @param {number} beta
   */
  at(beta) {
    const away = Math.log(this.beta / beta);
    return { least: Math.exp(this.least + 2 * away), most: Math.exp(this.most + away) };
  }

  /** The place (beta) where both meet: nearer the bridge no force will do. */
  get tip() {
    return this.beta * Math.exp(this.least - this.most);
  }
}

/** Places the bow by the diagram: where it is touched, there the bow is until it is let go. */
export class Diagram {
  /** @param {Schelleng} picture @param {Player} player */
  constructor(picture, player) {
    this.picture = picture;
    this.player = player;
    /** @type {number | null} the pointer that places the bow */
    this.by = null;
    new Pointers(picture.canvas, {
      down: (touch) => {
        this.by ??= touch.id;
        this.#place(touch);
      },
      move: (touches) => this.#place(touches[touches.length - 1]),
      up: (id) => {
        if (id !== this.by) return;
        this.by = null;
        player.release(); // the player has its bow back
      },
    });
  }

  /** @param {import("../hands/pointers.js").Touch} touch */
  #place({ id, x, y }) {
    if (id !== this.by) return;
    const { beta, force } = this.picture.pointAt(x, y);
    this.player.write("/bow/position", beta);
    this.player.write("/bow/force", force);
    this.picture.isStale = true; // seen at once
  }
}
