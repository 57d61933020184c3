/** Places the bow by Schelleng's diagram: where it is touched, there the bow is until it is let go. */

/** @typedef {import("../interfaces.js").Player} Player */
/** @typedef {import("../pictures/schelleng.js").Schelleng} Schelleng */

import { Pointers } from "./pointers.js";

export class Diagram {
  /**
   * @param {Schelleng} picture
   * @param {Player} player
   */
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

  /** @param {import("./pointers.js").Touch} touch */
  #place({ id, x, y }) {
    if (id !== this.by) return;
    const { beta, force } = this.picture.pointAt(x, y);
    this.player.write("/bow/position", beta);
    this.player.write("/bow/force", force);
    this.picture.isStale = true; // seen at once
  }
}
