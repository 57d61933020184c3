/** The notes of a tune, as they come: jianpu, how long they are, fingers, and what is in one bow. */

/** @typedef {import("../tune.js").TunePlayer | import("../tune.js").TuneGuide} Course */
/** @typedef {import("../hands/fingering.js").Note} Note */
/** @typedef {import("./picture.js").Moment} Moment */

import { jianpu } from "../hands/scale.js";
import { Picture, disc, font, line } from "./picture.js";

const NOW = 0.16; // of the width, where the present note is
const NEAREST = 30; // px between notes
const SPEEDS = /** @type {const} */ ([44, 230]); // px a second
const FOLLOWS = 8; // 1/s, as the picture goes on to the note that is waited for
const BAR = 7; // px
const SAID_MS = 1500;
const FINGERS = ["○", "①", "②", "③", "④"];
const STRINGS = /** @type {const} */ (["inner", "outer"]);

export class Score extends Picture {
  /** @type {Course | null} */
  #course = null;
  #shown = 0; // s, of what is at NOW
  #speed = 1; // px a second
  #word = "";
  #saidAt = -Infinity; // ms

  /** @param {Course | null} course */
  take(course) {
    this.#course = course;
    this.isStale = true;
    if (!course) return;
    this.#shown = course.now;
    const starts = course.notes.map(({ at }) => at);
    const gaps = starts.slice(1).map((at, i) => at - starts[i]);
    const shortest = Math.min(...gaps.filter((gap) => gap > 0.05), 1);
    this.#speed = Math.min(Math.max(NEAREST / shortest, SPEEDS[0]), SPEEDS[1]);
  }

  /** @param {string} word for a moment */
  say(word) {
    this.#word = word;
    this.#saidAt = performance.now();
    this.isStale = true;
  }

  get isMagnified() {
    return false;
  }

  /** @param {Moment} moment */
  draw({ state, elapsed, isCalm }) {
    const { context } = this;
    const course = this.#course;
    if (!course) return;
    const { colours, width, height } = this;
    const ahead = course.now - this.#shown;
    // One that goes on by itself is where it is; to a note that is waited for it glides.
    const isSmooth = !course.isTimed && !isCalm && Math.abs(ahead) > 0.01;
    this.#shown += isSmooth ? ahead * Math.min(FOLLOWS * elapsed, 1) : ahead;
    if (course.isOn && (course.isTimed || isSmooth)) this.wake();
    const now = Math.max(NOW * width, 44);
    const placeOf = (/** @type {number} */ at) => now + (at - this.#shown) * this.#speed;
    context.fillStyle = colours.accent;
    context.globalAlpha = 0.14;
    context.fillRect(now - 4, 0, 34, height);
    context.globalAlpha = 1;
    context.textAlign = "center";
    context.textBaseline = "middle";
    course.notes.forEach((note, i) => {
      const [from, to] = [placeOf(note.at), placeOf(note.until)];
      if (to < -20 || from > width + 20) return;
      const isPast = i < course.at && course.marks.length > 0;
      if (course.notes[i - 1]?.isTied) this.#arc(placeOf(course.notes[i - 1].at), from);
      const mark = isPast ? course.marks[i] : null;
      this.#note(note, course.fingering[i], from, to, mark, to < now);
    });
    if (state && state.bow.string >= 0 && state.bow.speed !== 0) this.#stroke(now, state.bow.speed);
    if (performance.now() - this.#saidAt < SAID_MS) {
      this.wake();
      this.#say();
    }
  }

  /**
   * @param {Note} note
   * @param {import("../hands/fingering.js").Fingered} fingered
   * @param {number} from px
   * @param {number} to
   * @param {boolean | null} mark whether it was right; null: not played yet
   * @param {boolean} isGone
   */
  #note({ pitch }, { string, finger }, from, to, mark, isGone) {
    const { context, colours, height } = this;
    const x = from + 12;
    const { digit, dots } = jianpu(pitch);
    context.globalAlpha = isGone ? 0.45 : 1;
    context.fillStyle = colours[STRINGS[string]];
    context.beginPath();
    context.roundRect(from, 0.63 * height, Math.max(to - from - 3, 8), BAR, BAR / 2);
    context.fill();
    context.font = font(15);
    context.fillText(FINGERS[finger], x, 0.86 * height);
    context.fillStyle = mark === null ? colours.ink : colours[mark ? "good" : "bad"];
    context.font = font(21, 650);
    context.fillText(digit, x, 0.4 * height);
    for (let dot = 1; dot <= Math.abs(dots); dot++) {
      const away = dots > 0 ? -9 - 5 * dot : 8 + 4 * dot;
      disc(context, x, 0.4 * height + away, 2, context.fillStyle);
    }
    context.globalAlpha = 1;
  }

  #say() {
    const { context, colours, width, height } = this;
    context.font = font(16, 600);
    context.textAlign = "left";
    context.fillStyle = colours.bad;
    const room = context.measureText(this.#word).width + 24;
    const left = width - room; // what is played now stays in sight
    context.beginPath();
    context.roundRect(left, 0.16 * height, room, 0.44 * height, 8);
    context.fill();
    context.fillStyle = colours.surface;
    context.fillText(this.#word, left + 12, 0.39 * height);
  }

  /** In one bow. @param {number} from @param {number} to px */
  #arc(from, to) {
    const { context, colours, height } = this;
    context.strokeStyle = colours.soft;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(from + 14, 0.16 * height);
    context.quadraticCurveTo((from + to) / 2 + 12, 0.02 * height, to + 10, 0.16 * height);
    context.stroke();
  }

  /**
   * The stroke that sounds: pulled (a box that is open below), or pushed (a wedge).
   * @param {number} now px
   * @param {number} speed
   */
  #stroke(now, speed) {
    const { context, colours, height } = this;
    const [left, top] = [now - 24, 0.3 * height];
    context.fillStyle = colours.surface;
    context.fillRect(left - 4, 0.1 * height, 22, 0.48 * height);
    context.strokeStyle = colours.ink;
    context.lineWidth = 2.5;
    const [right, bottom] = [left + 14, top + 14];
    if (speed > 0) line(context, [left, bottom], [left, top], [right, top], [right, bottom]);
    else line(context, [left, top], [left + 7, bottom], [right, top]);
  }
}
