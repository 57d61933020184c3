/** On the fingerboard: the notes of a tune that come next, and the way there from a wrong one. */

/** @typedef {import("./yehu.js").Yehu} Yehu */

import { disc, fill, line } from "./picture.js";

const RINGS = [25, 15, 10]; // px
const PULSE_S = 0.7;
const PULSE = 18; // px
const CLOSES_S = 1; // before its time a ring closes
const CLOSES = 46; // px
const WRONG_S = 1.4;

/**
 * @typedef {object} Targets
 * @property {number[]} pitches the next ones
 * @property {number} repeats how often the first comes
 * @property {number | null} due s until it should sound; null: it waits
 * @property {number} asked s, when it was asked for
 * @property {boolean} isAgain the same as the one before
 * @property {{pitch: number, at: number} | null} wrong a wrong note, and when it was
 */

/**
 * Draw them; return whether they move.
 * @param {Yehu} yehu whose context goes along and across the strings
 * @param {Targets} targets
 * @param {import("./picture.js").Moment} moment
 */
export function drawTargets(yehu, targets, { now, isCalm }) {
  const { context, colours } = yehu;
  const middle = yehu.surface.breadth / 2;
  const { pitches, due, asked, isAgain, wrong } = targets;
  if (pitches.length === 0) return false;
  const places = pitches.map((pitch) => yehu.placeOf(pitch));
  const since = now - asked;
  const isPulsing = isAgain && since < PULSE_S;
  const isWrong = wrong !== null && now - wrong.at < WRONG_S;
  context.strokeStyle = colours.accent;
  context.lineWidth = 2;
  context.globalAlpha = 0.35;
  line(context, ...places.map((place) => /** @type {const} */ ([place, middle])));
  places.slice(0, RINGS.length).forEach((place, i) => {
    if (i > 0 && pitches[i] === pitches[0]) return;
    context.globalAlpha = [1, 0.6, 0.4][i];
    context.lineWidth = i === 0 ? 4 : 2;
    ring(context, place, middle, RINGS[i]);
  });
  context.globalAlpha = 1;
  const [first] = places;
  if (isPulsing && !isCalm) {
    const share = since / PULSE_S;
    context.globalAlpha = 1 - share;
    ring(context, first, middle, RINGS[0] + PULSE * Math.sqrt(share));
    context.globalAlpha = 1;
  } else if (due !== null && due > 0 && due < CLOSES_S) {
    context.globalAlpha = 1 - 0.7 * due;
    ring(context, first, middle, RINGS[0] + CLOSES * due);
    context.globalAlpha = 1;
  }
  if (isWrong) arrow(yehu, yehu.placeOf(wrong.pitch), first);
  return isPulsing || isWrong || due !== null;
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 * @param {number} y
 * @param {number} radius px
 */
function ring(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.stroke();
}

/**
 * @param {Yehu} yehu
 * @param {number} from px along
 * @param {number} to
 */
function arrow({ context, colours, surface }, from, to) {
  const side = Math.sign(to - from);
  const tip = to - side * (RINGS[0] + 4);
  const middle = surface.breadth / 2;
  if ((tip - from) * side < 6) return;
  context.strokeStyle = colours.bad;
  context.lineWidth = 5;
  line(context, [from, middle], [tip - side * 8, middle]);
  disc(context, from, middle, 7, colours.bad);
  fill(context, [tip, middle], [tip - side * 14, middle - 9], [tip - side * 14, middle + 9]);
}
