/** The first minute: an invitation, and three gestures, each noticed when it is done. */

/** @typedef {import('../main.js').Page} Page */

import { find, make } from "../elements.js";
import { NOTES, signOf } from "../hands/keys.js";
import { onLanguage, translate } from "../i18n.js";
import { remember, settings } from "../settings.js";

const STEPS = ["slide", "rock", "bow"];
const FAR = 1.5; // semitones that are a slide
const LONG = 400; // ms in the green
const SLOWEST = 0.04; // m/s that is a stroke
const READ = 9000; // ms in which the last words are read
const HELP = "?";

/** @param {Page} page */
export function showGuide({ hands, bow, fingerboard, keys, yehu }) {
  const stage = find("stage", HTMLElement);
  const guide = find("guide", HTMLElement);
  let at = -1; // before it, or after
  let hasBegun = false;
  let goodMs = 0;
  let last = 0;

  const words = make("p");
  const dots = STEPS.map(() => make("i"));
  const skip = make("button", { type: "button", class: "quiet", id: "skip" });
  guide.append(words, make("span", { class: "steps", "aria-hidden": "true" }, dots), skip);

  const tell = () => {
    const name = STEPS[at] ?? "done";
    words.replaceChildren(
      translate(`guide.${name}`),
      make("span", {}, [translate(`guide.${name}.about`)]),
    );
    skip.textContent = translate(STEPS[at] ? "guide.skip" : "guide.close");
    dots.forEach((dot, step) => dot.classList.toggle("done", step < at));
    guide.classList.toggle("done", at >= STEPS.length);
  };
  const go = (/** @type {number} */ step) => {
    at = step;
    goodMs = 0;
    guide.hidden = at < 0;
    stage.dataset.step = STEPS[at] ?? "";
    tell();
    if (at < STEPS.length) return;
    remember({ isTaught: true });
    setTimeout(() => at === STEPS.length && go(-1), READ);
  };
  const notice = (/** @type {string} */ name) => {
    if (STEPS[at] === name) go(at + 1);
  };

  hands.addEventListener("change", () => {
    if (hands.fingers.some(({ pitch, begun }) => Math.abs(pitch - begun) > FAR)) notice("slide");
    const [from, to] = bow.playable ?? [0, -1];
    const now = performance.now();
    const isGood = bow.height >= from && bow.height <= to;
    if (isGood && hands.isBowing && Math.abs(hands.stroke.speed) > SLOWEST) {
      goodMs += Math.min(now - last, 100);
      if (goodMs > LONG) notice("bow");
    }
    last = now;
  });
  hands.addEventListener("rock", () => notice("rock"));
  skip.addEventListener("click", () => {
    remember({ isTaught: true });
    go(-1);
  });
  const help = () => go(at < 0 ? 0 : -1);
  find("help", HTMLButtonElement).addEventListener("click", help);
  window.addEventListener("keydown", ({ key, target }) => {
    if (key === HELP && !(target instanceof HTMLInputElement)) help();
  });
  onLanguage(tell);

  const begin = () => {
    find("invite", HTMLElement).hidden = true;
    if (!settings.isTaught && at < 0 && !hasBegun) go(0);
    hasBegun = true;
  };
  for (const hand of [keys, fingerboard, bow]) hand.addEventListener("play", begin);
  // The computer's keys are printed on the fingerboard, once one is pressed.
  const print = () => {
    yehu.keys = new Map([...NOTES].map(([code, note]) => [note + keys.octave, signOf(code)]));
    yehu.isStale = true;
  };
  keys.addEventListener("play", print, { once: true });
  keys.addEventListener("octave", () => yehu.keys.size && print());
}
