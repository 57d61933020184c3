/** The first minute: an invitation, three gestures, each noticed when it is done, and a challenge. */

/** @typedef {import('../main.js').Page} Page */

import { LASTS, Challenge, toneOf } from "../challenge.js";
import { find, make, makeButton, words } from "../elements.js";
import { isWriting, NOTES, signOf } from "../hands/keys.js";
import { onLanguage, translate } from "../i18n.js";
import { remember, settings } from "../settings.js";

const STEPS = ["begin", "slide", "rock", "bow", "tone"];
const TONE = STEPS.indexOf("tone");
const DONE = STEPS.length;
const FAR = 1.5; // semitones that are a slide
const LONG = 0.4; // s in the green
const SLOWEST = 0.04; // m/s that is a stroke
const HELP = "?";
const FIRST_NOTE = 69; // that a ring invites to

/**
 * @param {Page} page
 * @param {import('./tunes.js').Lesson} lesson
 * @param {Promise<void>} heard what the page's address brought, which comes first
 */
export function showGuide({ instrument, hands, bow, keys, midi, yehu }, lesson, heard) {
  const stage = find("stage", HTMLElement);
  const guide = find("guide", HTMLElement);
  let at = -1; // before it, or after
  let good = 0; // s
  let last = 0; // s
  let challenge = new Challenge();

  const said = make("p", { role: "status" });
  const live = make("p", { class: "live", "aria-hidden": "true" });
  const dots = STEPS.slice(1).map(() => make("i"));
  const again = makeButton(words("guide.again"), () => go(TONE));
  const play = () => lesson.first && lesson.toggle(lesson.first, "along");
  const easy = makeButton(words("guide.easy"), play, { class: "main", id: "easy" });
  const close = () => {
    remember({ isTaught: true });
    go(-1);
  };
  const skip = makeButton("", close, { class: "quiet", id: "skip" });
  const steps = make("span", { class: "steps", "aria-hidden": "true" }, dots);
  guide.append(steps, said, live, again, easy, skip);

  const result = () => {
    const { tone, longest, found } = challenge;
    if (challenge.gone === 0) return ["guide.done", translate("guide.done.about")];
    const values = {
      tone: tone.toFixed(1),
      longest: longest.toFixed(1),
      best: settings.bestTone.toFixed(1),
    };
    const came = found === null ? "" : translate("guide.found", { found: found.toFixed(1) });
    return ["guide.result", `${came} ${translate("guide.result.about", values)}`, values];
  };
  const update = () => {
    const name = STEPS[at];
    const [key, about, values] = name
      ? [`guide.${name}`, translate(`guide.${name}.about`)]
      : result();
    said.replaceChildren(
      translate(/** @type {string} */ (key), /** @type {any} */ (values)),
      make("span", {}, [/** @type {string} */ (about)]),
    );
    skip.textContent = translate(at < TONE ? "guide.skip" : "guide.close");
    dots.forEach((dot, step) => dot.classList.toggle("done", step + 1 < at));
    guide.classList.toggle("done", at >= DONE);
    again.hidden = easy.hidden = at < DONE;
    live.hidden = at !== TONE;
    live.textContent = "";
  };
  const go = (/** @type {number} */ step) => {
    at = step;
    good = 0;
    guide.hidden = at < 0;
    stage.dataset.step = STEPS[at] === "tone" ? "bow" : (STEPS[at] ?? "");
    if (!lesson.course) yehu.ask(STEPS[at] === "begin" ? FIRST_NOTE : null);
    if (at >= TONE) remember({ isTaught: true });
    if (at === TONE) challenge = new Challenge();
    update();
  };
  const notice = (/** @type {string} */ name) => {
    if (STEPS[at] === name) go(at + 1);
  };

  hands.addEventListener("change", () => {
    if (hands.fingers.some(({ pitch, begun }) => Math.abs(pitch - begun) > FAR)) notice("slide");
  });
  hands.addEventListener("rock", () => notice("rock"));
  instrument.addEventListener("state", () => {
    const { state } = instrument;
    const now = performance.now() / 1000;
    const lasted = Math.min(now - last, 0.1);
    last = now;
    if (STEPS[at] === "bow") {
      const [from, to] = bow.playable ?? [0, -1];
      const isGood = bow.height >= from && bow.height <= to;
      if (isGood && hands.isBowing && Math.abs(hands.stroke.speed) > SLOWEST) good += lasted;
      if (good > LONG) notice("bow");
    } else if (at === TONE && state) {
      const kind = hands.isBowing ? toneOf(state) : "none";
      challenge.take(kind, lasted);
      guide.dataset.tone = kind;
      live.textContent = translate("guide.live", {
        left: Math.ceil(LASTS - challenge.gone), tone: challenge.tone.toFixed(1),
      }); // prettier-ignore
      if (!challenge.isOver) return;
      remember({ bestTone: Math.max(settings.bestTone, challenge.tone) });
      go(DONE);
    }
  });
  lesson.addEventListener("change", () => lesson.course && go(-1)); // one at a time
  const help = () => go(at < 0 ? 1 : -1);
  find("help", HTMLButtonElement).addEventListener("click", help);
  window.addEventListener("keydown", ({ key, target }) => {
    if (key === HELP && !isWriting(target)) help();
  });
  onLanguage(update);
  let hasPlayed = false;
  heard.then(() => {
    if (!settings.isTaught && at < 0 && !lesson.course) go(hasPlayed ? 1 : 0);
  });

  const begin = () => {
    hasPlayed = true;
    find("invite", HTMLElement).hidden = true;
    notice("begin");
  };
  hands.addEventListener("play", begin);
  midi.addEventListener("play", begin);
  // The computer's keys are printed on the fingerboard, once one is pressed.
  const print = () => {
    yehu.keys = new Map([...NOTES].map(([code, note]) => [note + keys.octave, signOf(code)]));
    yehu.isStale = true;
  };
  keys.addEventListener("play", print, { once: true });
  keys.addEventListener("octave", () => yehu.keys.size && print());
}
