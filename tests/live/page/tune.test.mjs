/** Plays tunes along with guides that wait or keep time, without a browser; prints what they found. */

import { pathToFileURL } from "node:url";

const [folder] = process.argv.slice(2);
const load = (/** @type {string} */ name) => import(pathToFileURL(`${folder}/${name}`).href);
globalThis.window = /** @type {any} */ (globalThis);
let [clock, tick] = [1000, () => {}];
globalThis.setInterval = /** @type {any} */ ((action) => ((tick = action), 1));
globalThis.clearInterval = () => {};
performance.now = () => clock;

const { default: facts } = await load("facts.js");
const { default: examples } = await load("examples.js");
const { TuneGuide } = await load("tune.js");
const { notesOf } = await load("hands/fingering.js");
const { Challenge } = await load("challenge.js");
const { jianpuText, setTonic } = await load("hands/scale.js");
const { BEGIN, SLIDE, DRAW } = facts.kinds;

/** @param {number[]} pitches a second each */
const tuneOf = (pitches) => ({
  name: "any",
  seconds: pitches.length,
  events: pitches.flatMap((pitch, at) => [
    [at, [0x90, pitch, 80]],
    [at + 0.8, [0x80, pitch, 64]],
  ]),
});

/** @param {number[]} pitches @param {boolean} isTimed */
function follow(pitches, isTimed) {
  const instrument = new EventTarget();
  const guide = new TuneGuide(instrument, tuneOf(pitches), 1, isTimed);
  const wrong = [];
  guide.addEventListener("wrong", () => wrong.push(guide.pitch));
  guide.start();
  const command = (kind, value, other) =>
    instrument.dispatchEvent(new CustomEvent("command", { detail: { kind, value, other } }));
  return {
    guide,
    wrong,
    begin: (pitch) => command(BEGIN, 0, pitch),
    slide: (pitch) => command(SLIDE, pitch, 0),
    draw: (speed) => command(DRAW, speed, 1),
    wait: (seconds) => {
      clock += 1000 * seconds;
      tick();
    },
  };
}

const found = {};

const waiting = follow([65, 65, 67, 69], false);
const way = [];
for (const act of [
  () => waiting.begin(65.2),
  () => waiting.slide(65.1), // no other note is begun
  () => waiting.begin(65),
  () => waiting.begin(69), // wrong
  () => waiting.slide(67),
  () => waiting.begin(69),
]) {
  act();
  way.push(waiting.guide.at);
}
found.waiting = {
  way,
  wrong: waiting.wrong,
  result: waiting.guide.result,
  isOn: waiting.guide.isOn,
};

const bowed = follow([65, 65, 67], false);
bowed.slide(65);
bowed.draw(0.2);
bowed.draw(0.1);
const before = bowed.guide.at;
bowed.draw(-0.2);
found.bowed = [before, bowed.guide.at];

const timed = follow([65, 67, 69, 70], true);
timed.wait(2.1);
timed.begin(65); // 100 ms late
timed.wait(0.9);
timed.begin(67); // in time
timed.wait(1.0);
timed.begin(70); // wrong
timed.wait(1.0); // 69 is missed
timed.begin(70);
timed.wait(1.5);
found.timed = { wrong: timed.wrong, result: timed.guide.result, isOn: timed.guide.isOn };

found.left = follow([65, 67], false).guide.result;

found.tunes = Object.values(examples).map((tune) => {
  setTonic(tune.tonic);
  const notes = notesOf(tune);
  return {
    name: tune.name,
    isEasy: tune.isEasy,
    jianpu: notes
      .slice(0, 7)
      .map(({ pitch }) => jianpuText(pitch))
      .join(" "),
    range: [
      Math.min(...notes.map(({ pitch }) => pitch)),
      Math.max(...notes.map(({ pitch }) => pitch)),
    ],
    tied: notes.filter(({ isTied }) => isTied).length,
    count: notes.length,
    isInOrder: notes.every(({ at, until }, i) => at < until && at >= (notes[i - 1]?.at ?? 0)),
  };
});

const challenge = new Challenge();
challenge.take("none", 5); // it has not begun
for (const [kind, seconds] of [
  ["scratch", 2], ["light", 1], ["tone", 3], ["none", 0.5], ["tone", 4], ["scratch", 1], ["tone", 30],
]) challenge.take(kind, seconds); // prettier-ignore
const { gone, tone, longest, isOver } = challenge;
found.challenge = { gone, tone, longest, found: challenge.found, isOver };
console.log(JSON.stringify(found));
