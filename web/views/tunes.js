/** Tunes to listen to, to play with one that waits, or in time; while one is on, its notes stand over the strings. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../tune.js').Tune} Tune */
/** @typedef {'listen' | 'along' | 'timed'} Way */

import { find, make, makeButton, makeSwitch, note, words } from "../elements.js";
import { jianpuText } from "../hands/scale.js";
import { TuneGuide, TunePlayer } from "../tune.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { remember, settings } from "../settings.js";
import { clock } from "./recording.js";

/** @type {Way[]} */
const WAYS = ["listen", "along", "timed"];
const SLOWLY = 2 / 3;
const SHOWN = 3; // notes that come next, on the fingerboard

/** @param {Page} page @param {() => void} clear shows the instrument, where a panel lies over it */
export function showTunes(page, clear) {
  const lesson = new Lesson(page, clear);
  const slowly = makeSwitch(words("tunes.slowly"), settings.isSlow, (isSlow) =>
    remember({ isSlow }),
  );
  const list = make("div", { class: "group" });
  find("panel-tunes", HTMLElement).append(note(words("tunes.about")), slowly, list);
  import("../examples.js").then(
    ({ default: examples }) => {
      // The type of a JSON list does not have its places, so that `events` gets it here.
      const tunes = /** @type {Tune[]} */ (/** @type {unknown} */ (Object.values(examples)));
      list.append(...tunes.map((tune) => row(lesson, tune)));
      lesson.first = tunes[0];
    },
    () => list.append(make("p", {}, [words("tunes.none")])),
  );
  return lesson;
}

/** @param {Tune} tune */
const nameOf = ({ name }) => translateOr(`tune.${name}`, name.replace(/_/g, " "));

/** @param {Lesson} lesson @param {Tune} tune */
function row(lesson, tune) {
  const name = () => nameOf(tune);
  const buttons = WAYS.map((way) => {
    const button = makeButton("", () => lesson.toggle(tune, way));
    const update = () => {
      const isOn = lesson.isOn(tune, way);
      const word = translate(isOn ? "tunes.stop" : `tunes.${way}`);
      button.setAttribute("aria-label", `${word}: ${name()}`);
      button.setAttribute("aria-pressed", String(isOn));
      button.textContent = word;
    };
    lesson.addEventListener("change", update);
    onLanguage(update);
    return button;
  });
  const bar = make("progress", { max: 1, value: 0, "aria-label": name, hidden: true });
  lesson.addEventListener("move", () => {
    bar.hidden = lesson.tune !== tune || !lesson.course;
    bar.value = lesson.course?.progress ?? 0;
  });
  const easy = tune.isEasy ? [make("span", { class: "easy" }, [words("tunes.easy")])] : [];
  return make("article", { class: "tune" }, [
    make("h2", {}, [name, " ", make("span", { class: "soft" }, [clock(tune.seconds)]), ...easy]),
    note(() => translateOr(`tune.${tune.name}.about`, "")),
    make("div", { class: "row" }, buttons),
    bar,
  ]);
}

/** What is on. Events: 'change' of another tune or way, and 'move'. */
export class Lesson extends EventTarget {
  /** @type {TunePlayer | TuneGuide | null} */
  course = null;
  /** @type {Tune | null} the one that is on, or that was */
  tune = null;
  /** @type {Way} */
  way = "listen";
  /** The note that is asked for. @type {import('../hands/fingering.js').Note | undefined} */
  asked = undefined;
  /** The easiest tune. @type {Tune | null} */
  first = null;

  /** @param {Page} page @param {() => void} clear */
  constructor(page, clear) {
    super();
    this.page = page;
    this.clear = clear;
    this.bar = find("lesson", HTMLElement);
    this.canvas = find("score", HTMLCanvasElement);
    this.said = find("said", HTMLElement);
    this.again = find("again", HTMLButtonElement);
    this.stopper = find("stop", HTMLButtonElement);
    page.instrument.addEventListener("silence", () => this.course?.stop());
    this.stopper.addEventListener("click", () =>
      this.course ? this.course.stop() : this.#leave(),
    );
    onLanguage(() => this.#update());
    this.again.addEventListener("click", () => this.tune && this.toggle(this.tune, this.way));
  }

  /** @param {Tune} tune @param {Way} way */
  isOn(tune, way) {
    return this.course !== null && this.tune === tune && this.way === way;
  }

  /**
   * Begin a tune, or end it where it is on.
   * @param {Tune} tune
   * @param {Way} way
   */
  async toggle(tune, way) {
    const isOn = this.isOn(tune, way);
    this.course?.stop();
    if (isOn) return;
    const { instrument, score, yehu } = this.page;
    await instrument.start();
    if (!instrument.sound) return;
    const pace = settings.isSlow ? SLOWLY : 1;
    const course =
      way === "listen"
        ? new TunePlayer(instrument, tune, pace)
        : new TuneGuide(instrument, tune, pace, way === "timed");
    Object.assign(this, { course, tune, way, asked: undefined });
    this.page.setTonic(tune.tonic);
    this.bar.hidden = this.canvas.hidden = false;
    find("invite", HTMLElement).hidden = true;
    this.again.hidden = true;
    this.said.textContent = "";
    this.said.className = "unseen";
    yehu.showsFingers = true;
    course.addEventListener("move", () => this.#move());
    course.addEventListener("wrong", () => this.#answer(/** @type {TuneGuide} */ (course)));
    course.addEventListener("end", () => this.#end(course));
    this.clear();
    score.take(course);
    course.start();
    this.#update();
  }

  #move() {
    const { course } = this;
    const { yehu, fingerboard } = this.page;
    if (!course) return;
    const { notes, at } = course;
    const [next, ...others] = notes.slice(at, at + SHOWN);
    const isNew = next !== this.asked;
    this.asked = next;
    const now = performance.now() / 1000;
    yehu.targets = next
      ? {
          pitches: [next, ...others].map(({ pitch }) => pitch),
          repeats: course instanceof TuneGuide ? course.repeats : 1,
          due: course.isTimed ? (next.at - course.now) / course.pace : null,
          asked: isNew ? now : (yehu.targets?.asked ?? now),
          isAgain: notes[at - 1]?.pitch === next.pitch,
          wrong: isNew ? null : (yehu.targets?.wrong ?? null),
        }
      : null;
    // Where somebody plays, the board shows what comes; else it follows what sounds.
    if (course instanceof TuneGuide) fingerboard.bring(next?.pitch ?? null);
    if (isNew) yehu.isStale = this.page.score.isStale = true;
    this.dispatchEvent(new Event("move"));
  }

  /** @param {TuneGuide} guide */
  #answer({ pitch, notes, at }) {
    const { yehu, score } = this.page;
    const wanted = notes[at].pitch;
    const key = pitch < wanted ? "tunes.higher" : "tunes.lower";
    if (yehu.targets) yehu.targets.wrong = { pitch, at: performance.now() / 1000 };
    this.said.textContent = translate(key, { note: jianpuText(wanted) });
    score.say(this.said.textContent);
  }

  /** @param {TunePlayer | TuneGuide} course */
  #end(course) {
    if (this.course !== course) return;
    this.course = null;
    const { yehu, score, fingerboard } = this.page;
    yehu.ask(null);
    yehu.showsFingers = false;
    fingerboard.bring(null);
    score.take(null);
    const result = course instanceof TuneGuide ? course.result : null;
    if (!result) return this.#leave();
    this.canvas.hidden = true;
    this.again.hidden = false;
    this.said.className = "";
    this.said.textContent = resultText(result, course.isTimed);
    this.#update();
  }

  #leave() {
    this.bar.hidden = true;
    this.page.setTonic(null);
    this.tune = null;
    this.#update();
  }

  #update() {
    const word = translate(this.course ? "tunes.stop" : "guide.close");
    this.stopper.textContent = word;
    this.stopper.setAttribute("aria-label", this.tune ? `${word}: ${nameOf(this.tune)}` : word);
    this.dispatchEvent(new Event("change"));
    this.dispatchEvent(new Event("move"));
  }
}

/**
 * What went well, and what is worth another try.
 * @param {NonNullable<TuneGuide["result"]>} result
 * @param {boolean} isTimed
 */
function resultText({ right, count, run, late, hardest }, isTimed) {
  const said = [translate(isTimed ? "tunes.intime" : "tunes.right", { right, count })];
  if (right === count) said.push(translate("tunes.all"));
  else if (run > 2) said.push(translate("tunes.run", { run }));
  const ms = Math.abs(Math.round(100 * late) * 10);
  if (isTimed && ms) said.push(translate(late > 0 ? "tunes.late" : "tunes.early", { ms }));
  if (hardest) {
    const [from, to] = hardest.map(({ pitch }) => jianpuText(pitch));
    said.push(translate("tunes.hardest", { from, to }));
  }
  return said.join(" ");
}
