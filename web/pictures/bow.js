/** The bow on the instrument, and where on the hand's way the string sounds well. */

/** @typedef {import('./yehu.js').Yehu} Yehu */

import { disc } from "./picture.js";
import { laneOf } from "./wood.js";

const USUAL_BETA = 0.13;
const LONG = 0.84; // of the breadth, the whole hair
const STICK = 0.05; // of the breadth, from the hair to the stick
const THIN = 3;
const THICK = 9; // px, of the hair from light to firm
const FIRM = 3; // N
const MARKS = 26; // along the hair
const NEAR_END = 0.06; // of the hair

/**
 * @param {Yehu} yehu whose context goes along and across the strings
 * @param {import('../interfaces.js').Snapshot | null} state
 * @param {boolean} isCalm the bow rests, and the string goes along it
 */
export function drawBow({ context, surface, bow, colours }, state, isCalm) {
  const { breadth } = surface;
  const along = surface.bowAt(state?.bow.beta ?? USUAL_BETA);
  const string = state?.bow.string ?? -1;
  const isOn = string >= 0;
  const lane = isOn ? laneOf(surface, string) : breadth / 2;
  const long = LONG * breadth;
  const hair = state?.hair;
  const share = hair && hair.length > 0 ? hair.place / hair.length : 0.5;
  const place = Math.min(Math.max(share, 0), 1); // of the string on the hair, from the frog
  const isByHand = bow.by !== null && bow.way.length > 0;
  // The frog is on the side that is loud: at the right hand, or above.
  const out = surface.isUpright ? 1 : -1;
  let frog = lane + out * (isCalm ? 0.5 : place) * long;
  if (isByHand && !isCalm) frog = bow.way[bow.way.length - 1].place + out * 0.5 * long;
  const tip = frog - out * long;
  const stick = Math.min(Math.max(STICK * breadth, 10), 26);
  const force = Math.abs(state?.bow.force ?? 0);
  const thick = Math.round(THIN + (THICK - THIN) * Math.min(force / FIRM, 1));
  context.globalAlpha = isOn ? 1 : 0.55;
  context.lineCap = "round";
  context.strokeStyle = colours.edge;
  context.lineWidth = 5;
  context.beginPath();
  context.moveTo(along, tip);
  context.quadraticCurveTo(along - stick, tip, along - stick, tip + out * 0.16 * long);
  context.lineTo(along - stick, frog + out * 12);
  context.stroke();
  context.fillStyle = colours.hair;
  context.fillRect(along - thick / 2, Math.min(tip, frog), thick, long);
  context.fillStyle = colours.shell;
  context.beginPath();
  context.roundRect(along - stick - 1, frog - (out > 0 ? 4 : 12), stick + thick / 2 + 3, 16, 4);
  context.fill();
  context.strokeStyle = colours.edge;
  context.lineWidth = 1;
  context.globalAlpha *= 0.7;
  context.beginPath();
  for (let mark = 1; mark < MARKS; mark++) {
    const across = tip + (mark / MARKS) * (frog - tip);
    context.moveTo(along - thick / 2, across - 2);
    context.lineTo(along + thick / 2, across + 2);
  }
  context.stroke();
  context.globalAlpha = 1;
  if (!isOn) return;
  const left = hair && hair.length > 0 ? Math.min(place, 1 - place) : 1;
  const colour = left < NEAR_END ? colours.bad : colours[string ? "outer" : "inner"];
  disc(context, along, isCalm ? frog - out * place * long : lane, 5 + thick / 3, colour);
}

/**
 * The forces with which the string sounds well, at the present speed, along the hand's way.
 * @param {Yehu} yehu
 */
export function drawForces({ context, surface, bow, colours }) {
  const { length, breadth, board } = surface;
  const heights = bow.playable;
  const placeOf = (/** @type {number} */ height) => board[1] + height * (length - board[1]);
  if (heights) {
    const [from, to] = heights.map(placeOf);
    context.fillStyle = colours.good;
    context.globalAlpha = 0.16;
    context.fillRect(from, 0, to - from, breadth);
    context.globalAlpha = 0.6;
    for (const edge of [from, to]) context.fillRect(edge - 1, 0, 2, breadth);
    context.globalAlpha = 1;
  }
  const isGood = !heights || (bow.height >= heights[0] && bow.height <= heights[1]);
  context.fillStyle = isGood ? colours.good : colours.bad;
  context.globalAlpha = 0.8;
  context.fillRect(placeOf(bow.height) - 2, 0, 4, breadth);
  context.globalAlpha = 1;
}
