/** The parts of the yehu that do not move: neck, pegs, coconut, and the places of the notes. */

/** @typedef {import("../hands/surface.js").Surface} Surface */
/** @typedef {import("../hands/scale.js").Scale} Scale */
/** @typedef {import("./picture.js").Colours} Colours */

import { HIGHEST, LOWEST, OPEN, isDegree, jianpu, letterOf } from "../hands/scale.js";
import { translate } from "../i18n.js";
import { disc, font, line } from "./picture.js";

const NECK = 0.055; // half its width, of the breadth
const MAX_NECK = 30; // px
const APART = 0.55; // of the neck's half width: each string from the middle
const LABELS = 66; // px at the soft side, with the names of notes
const GRAINS = 5;
const MIN_FOR_SOFT = 340; // px across: else a button is there
const DIGIT = 19; // px, of a note in jianpu
const KEY = 22; // px, the side of a printed key
const BESIDE = 62; // px from the edge, where buttons for lower and higher notes stand

/** Half the width of the neck, px. @param {Surface} surface */
function neckOf({ breadth }) {
  return Math.min(NECK * breadth, MAX_NECK);
}

/**
 * Where across the instrument a string lies; the outer one is on the side of loud notes.
 * @param {Surface} surface
 * @param {number} string
 */
export function laneOf(surface, string) {
  const side = (surface.isUpright ? 1 : -1) * (string === 1 ? 1 : -1);
  return surface.breadth / 2 + side * APART * neckOf(surface);
}

export class Wood {
  /**
   * @param {CanvasRenderingContext2D} context along and across the strings, px
   * @param {Surface} surface
   * @param {Colours} colours
   */
  constructor(context, surface, colours) {
    this.context = context;
    this.surface = surface;
    this.colours = colours;
    this.neck = neckOf(surface);
    this.middle = surface.breadth / 2;
  }

  /** The room of loud and soft notes beside the neck. */
  drawField() {
    const { context, surface, colours } = this;
    const [from, to] = surface.board;
    const field = context.createLinearGradient(0, surface.loudnessAt(0), 0, surface.loudnessAt(1));
    field.addColorStop(0, `${colours.glow}00`);
    field.addColorStop(1, colours.glow);
    context.globalAlpha = 0.6;
    context.fillStyle = field;
    context.fillRect(from, 0, to - from, surface.breadth);
    context.globalAlpha = 1;
  }

  /** A line where each note is. @param {Scale} scale */
  drawNotes(scale) {
    const { context, surface, colours } = this;
    const [from] = surface.board;
    const soft = surface.isUpright ? LABELS : surface.breadth - LABELS;
    for (const note of notesOf(scale)) {
      const open = OPEN.indexOf(note);
      context.globalAlpha = open >= 0 ? 0.9 : isDegree(note) ? 0.8 : 0.35;
      context.strokeStyle = open < 0 ? colours.line : colours[open ? "outer" : "inner"];
      context.lineWidth = open >= 0 ? 2 : isDegree(note) ? 1.5 : 1;
      const along = from + scale.placeOf(note);
      line(context, [along, soft], [along, surface.loudnessAt(1)]);
    }
    context.globalAlpha = 1;
  }

  drawNeck() {
    const { context, surface, colours, neck, middle } = this;
    const [from] = surface.board;
    const wood = context.createLinearGradient(0, middle - neck, 0, middle + neck);
    wood.addColorStop(0, colours.edge);
    wood.addColorStop(0.35, colours.wood);
    wood.addColorStop(1, colours.edge);
    context.fillStyle = wood;
    context.strokeStyle = colours.shell;
    context.lineWidth = 1;
    for (const peg of [0.34, 0.68]) this.#peg(peg * from);
    context.fillStyle = wood;
    context.beginPath();
    context.roundRect(3, middle - neck, surface.centre, 2 * neck, [neck, 4, 4, neck]);
    context.fill();
    context.stroke();
  }

  /** @param {number} along */
  #peg(along) {
    const { context, colours, neck, middle } = this;
    const long = 2.4 * neck;
    context.fillStyle = colours.shell;
    context.beginPath();
    context.roundRect(along - 4, middle - long, 8, 2 * long, 3);
    context.roundRect(along - 6.5, middle - long - 10, 13, neck + 10, 6);
    context.fill();
  }

  /** The half coconut, seen on its lid of wood, with the bridge. */
  drawCoconut() {
    const { context, surface, colours, middle, neck } = this;
    const { centre, round, bridge } = surface;
    disc(context, centre, middle, round, colours.shell);
    context.strokeStyle = colours.edge;
    context.lineWidth = 1;
    context.globalAlpha = 0.5;
    for (let angle = 0; angle < 2 * Math.PI; angle += Math.PI / 24) {
      // Fibres of the shell.
      const [inner, outer] = [0.9 * round, 0.985 * round];
      line(
        context,
        [centre + inner * Math.cos(angle), middle + inner * Math.sin(angle)],
        [centre + outer * Math.cos(angle + 0.06), middle + outer * Math.sin(angle + 0.06)],
      );
    }
    context.globalAlpha = 1;
    const lid = context.createRadialGradient(centre, middle, 0, centre, middle, 0.88 * round);
    lid.addColorStop(0, colours.lid);
    lid.addColorStop(1, colours.wood);
    disc(context, centre, middle, 0.88 * round, lid);
    context.save();
    context.clip();
    context.globalAlpha = 0.25;
    for (let grain = -GRAINS; grain <= GRAINS; grain++) {
      const across = middle + (grain / GRAINS) * 0.85 * round;
      context.beginPath();
      context.moveTo(centre - round, across);
      context.bezierCurveTo(
        centre - round / 3, across + 0.06 * round, centre + round / 3, across - 0.06 * round,
        centre + round, across,
      ); // prettier-ignore
      context.stroke();
    }
    context.restore();
    context.fillStyle = colours.shell;
    context.beginPath();
    context.roundRect(bridge - 4, middle - 1.5 * neck, 8, 3 * neck, 3);
    context.fill();
    disc(context, centre + 0.86 * round, middle, 0.05 * round + 2, colours.shell); // the tail pin
  }

  /** The loop that holds both strings to the neck. @param {Scale} scale */
  drawLoop(scale) {
    const { context, surface, colours, neck, middle } = this;
    if (scale.first > LOWEST) return;
    context.fillStyle = colours.shell;
    context.fillRect(
      surface.board[0] + scale.placeOf(LOWEST) - 3,
      middle - neck - 2,
      5,
      2 * neck + 4,
    );
  }
}

/**
 * Write the notes' names as jianpu and letters; and the computer's keys, once they are played.
 * @param {import("./yehu.js").Yehu} yehu
 */
export function writeNotes({ context, surface, colours, fingerboard: { scale }, keys, write }) {
  const { board, breadth, isUpright } = surface;
  const put = (/** @type {number} */ beside) => (isUpright ? beside : breadth - beside);
  context.textAlign = "center";
  context.textBaseline = "middle";
  // Upright, a digit with its dots has to fit below that of the note a semitone lower.
  const semitone = scale.placeOf(OPEN[0] + 1) - scale.placeOf(OPEN[0]);
  const size = isUpright ? Math.min(DIGIT, 0.68 * Math.abs(semitone)) : DIGIT;
  for (const note of notesOf(scale)) {
    const along = board[0] + scale.placeOf(note);
    const open = OPEN.indexOf(note);
    context.fillStyle = open < 0 ? colours.ink : colours[open ? "outer" : "inner"];
    if (isDegree(note)) {
      const { digit, dots } = jianpu(note);
      context.font = font(size, 650);
      write(digit, along, put(isUpright ? 16 : 40));
      context.font = font(size, 700);
      for (let dot = 0; dot < Math.abs(dots); dot++) {
        const away = (size / DIGIT) * (dots > 0 ? -11 - 4.6 * dot : 12 + 4.6 * dot);
        if (isUpright) write("·", along + away, 16);
        else write("·", along, put(40) + away);
      }
      context.font = font(14);
      context.fillStyle = open < 0 ? colours.soft : context.fillStyle;
      write(letterOf(note), along, put(isUpright ? 42 : 16));
    }
    const key = keys.get(note);
    if (key) {
      const across = surface.loudnessAt(1) + (isUpright ? -(scale.isPart ? BESIDE : 18) : 18);
      const [x, y] = isUpright ? [across, along] : [along, across];
      context.globalAlpha = 0.85;
      context.fillStyle = colours.surface;
      context.strokeStyle = colours.faint;
      context.beginPath();
      context.roundRect(x - KEY / 2, y - KEY / 2, KEY, KEY, 5);
      context.fill();
      context.stroke();
      context.globalAlpha = 1;
      context.font = font(14, 600);
      context.fillStyle = colours.ink;
      write(key, along, across);
    }
  }
  context.font = font(14, 600);
  context.fillStyle = colours.soft;
  const loud = isUpright ? breadth - 24 : 14;
  write(translate("board.loud"), board[0] - 18, loud);
  if (isUpright || breadth > MIN_FOR_SOFT) {
    write(translate("board.soft"), board[0] - 18, put(LABELS + (isUpright ? -24 : 10)));
  }
}

/** @param {Scale} scale */
function notesOf(scale) {
  const first = Math.max(Math.ceil(scale.pitchAt(0)), LOWEST);
  const last = Math.min(Math.floor(scale.pitchAt(scale.length)), HIGHEST);
  return Array.from({ length: last - first + 1 }, (_, step) => first + step);
}
