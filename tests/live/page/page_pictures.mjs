/** Asks the pictures' own arithmetic, without a browser; prints what it answers.
 *
 *   node page_pictures.mjs FOLDER
 */

import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const web = pathToFileURL(`${resolve(process.argv[2])}/`);
const { RestShape, Stroboscope } = await import(new URL("pictures/stroboscope.js", web).href);
const { Limits } = await import(new URL("pictures/schelleng.js", web).href);
const { SteadyPitch, regimeOf, soundingPitch } = await import(
  new URL("sound/snapshot.js", web).href
);

const POINTS = 64;

/**
 * The ideal Helmholtz motion: two straight lines, and a corner that runs around once in a period.
 * @param {number} phase
 */
function helmholtz(phase) {
  const round = phase - Math.floor(phase);
  const corner = round < 0.5 ? 2 * round : 2 - 2 * round;
  const height = (round < 0.5 ? 1 : -1) * corner * (1 - corner);
  return Float32Array.from({ length: POINTS }, (_, i) => {
    const x = i / (POINTS - 1);
    return height * Math.min(x / Math.max(corner, 1e-9), (1 - x) / Math.max(1 - corner, 1e-9));
  });
}

/**
 * Where the corners of the shapes are, as the stroboscope shows one period slowly.
 * @param {number} error of the period that is reported
 */
function corners(error) {
  const stroboscope = new Stroboscope();
  const period = 1 / 441.3;
  for (let n = 0; n < 300; n++) {
    const time = n / 60 + 0.0013 * Math.sin(n); // snapshots do not come evenly
    stroboscope.add(helmholtz(time / period), time, period * (1 + error));
  }
  return Array.from({ length: 64 }, (_, step) => {
    const shape = stroboscope.at(step / 64);
    let largest = 0;
    for (let i = 0; i < POINTS; i++) if (Math.abs(shape[i]) > Math.abs(shape[largest])) largest = i;
    const [at, sign] = [largest / (POINTS - 1), Math.sign(shape[largest])];
    return sign > 0 ? at / 2 : 1 - at / 2; // its way, as a share of the period
  });
}

/** How far from the motion is what is shown of a string that a finger also presses aside. */
function restError() {
  const rest = new RestShape();
  const pressed = Float32Array.from({ length: POINTS }, (_, i) => -3 * Math.min(i / 20, 1));
  let error = 0;
  for (let n = 0; n < 400; n++) {
    const motion = helmholtz(n * 0.37);
    const shown = rest.without(
      motion.map((y, i) => y + pressed[i]),
      {
        fingers: [{ x: 0.1, press: 1, string: 0 }],
        bow: { string: 0 },
      },
    );
    if (n < 200) continue;
    error = Math.max(error, ...shown.map((y, i) => Math.abs(y - motion[i])));
  }
  return error;
}

/** The limits at three places, reported of a bow that has just moved from one place to another. */
function limits() {
  const moved = new Limits();
  const [least, most] = [0.0008, 0.2]; // N at beta 1
  for (const [beta, times] of [
    [0.1, 120],
    [0.2, 1],
  ]) {
    const bow = { string: 0, speed: 0.2, force: 0.5, beta, x: 0.3 };
    const schelleng = { min: least / beta ** 2, max: most / beta };
    for (let n = 0; n < times; n++) moved.follow({ bow, schelleng }, 1 / 60);
  }
  return [...[0.05, 0.1, 0.4].map((beta) => moved.at(beta)), moved.tip];
}

const state = {
  pitch: 69,
  level: -12,
  schelleng: { min: 0.05, max: 1.5 },
  bow: { string: 0, speed: 0.2, force: 0.5, beta: 0.13, x: 0.3 },
  heard: { certainty: 0.97, errorCents: 12, slips: 1 },
};
const heard = (/** @type {object} */ changes) => ({
  ...state.heard,
  ...changes,
});
const bow = (/** @type {object} */ changes) => ({ ...state.bow, ...changes });
/** What a tuner reads of a vibrato about 69.05, after each look at it, and of the next note and silence. */
function readings() {
  const tuner = new SteadyPitch();
  const read = (/** @type {number} */ pitch, /** @type {number} */ time) => {
    tuner.take(pitch, time);
    return tuner.pitch;
  };
  const times = Array.from({ length: 100 }, (_, i) => i / 50);
  const vibrato = times.map((time) => read(69.05 + 0.3 * Math.sin(2 * Math.PI * 5.5 * time), time));
  return {
    vibrato: vibrato.slice(40),
    next: read(70.1, 2),
    silence: read(NaN, 2.1),
    again: read(62, 2.2),
  };
}

console.log(
  JSON.stringify({
    rest: restError(),
    limits: limits(),
    exact: corners(0),
    drifting: corners(2e-4),
    regimes: {
      helmholtz: regimeOf(state),
      slipping: regimeOf({ ...state, heard: heard({ slips: 2 }) }),
      raucous: regimeOf({
        ...state,
        heard: heard({ certainty: 0.3 }),
        bow: bow({ force: 3 }),
      }),
      unheard: regimeOf({ ...state, heard: heard({ certainty: 0 }) }),
      settling: regimeOf({ ...state, heard: heard({ certainty: 0.3 }) }),
      ringing: regimeOf({ ...state, bow: bow({ string: -1 }) }),
      silent: regimeOf({ ...state, bow: bow({ string: -1 }), level: -100 }),
    },
    pitch: soundingPitch(state),
    unheard: soundingPitch({ ...state, heard: heard({ certainty: 0.2 }) }),
    readings: readings(),
  }),
);
