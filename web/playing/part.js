/** The part that the page plays: interprets events to commands, and keeps the values of its parameters. */

import facts from "../facts.js";
import { FREE, find } from "./table.js";
import { writeTables, writeTuning } from "./tables.js";

const { WRITE, DRAW, STOP } = facts.kinds;
const { SET, TABLES_TO } = facts.events;
const { index: SECTION } = find("/playing/section");
const [BOW_SPEED, BOW_FORCE, BOW_ASSIST] = ["/bow/speed", "/bow/force", "/bow/assist"].map(find);
// Within this time the sound has a write, and reports the value that it moves to.
const REPORTED_WITHIN_S = 0.1;

/**
 * @typedef {import('./interpreter.js').Interpreter} Interpreter
 * @typedef {import('./learned.js').Mapping} Mapping
 * @typedef {import('./tables.js').Tuning} Tuning
 *
 * @typedef {import('../interfaces.js').SoundMembers} SoundMembers
 *
 * @typedef {object} Others What a sink may know of those who play the same.
 * @property {number} [rate] Hz
 * @property {(address: string) => number | undefined} [wasSet] the value of a parameter that was set, which notes
 *   and controllers move from
 * @property {(index: number, value: number) => unknown} [follow] take what others have set
 *
 * @typedef {Pick<SoundMembers, "post" | "frame" | "target" | "reported" | "maxPlayers"> & Others} Sink What commands
 *   are posted to.
 */

/** Interprets events, and posts the commands that result; a frame of null is now. */
export class Part {
  #sink;
  #now = 0; // frame of the last event for now
  /** The last writes, by index. @type {Map<number, {value: number, frame: number}>} */
  #written = new Map();
  /** What others, or this page, set last, by index. @type {Map<number, number>} */
  #lastSet = new Map();
  /** Before there is one, events have no effect. @type {Interpreter | null} */
  interpreter = null;

  /** @param {Sink} sink */
  constructor(sink) {
    this.#sink = sink;
  }

  get #frame() {
    return this.#sink.frame ?? 0;
  }

  /**
   * Interpret an event, and post the commands that result.
   * @param {number | null} frame
   * @param {number} kind
   * @param {number} [index]
   * @param {number} [value]
   * @param {number} [other]
   */
  take(frame, kind, index = 0, value = 0, other = 0) {
    const { interpreter } = this;
    if (interpreter === null) return;
    this.#learnValues(interpreter);
    // What is for now has a frame of its own, before all others.
    const commands = interpreter.take(frame ?? --this.#now, kind, index, value, other);
    for (const [kind, index, value, other] of commands) {
      const isSection = kind === WRITE && index === SECTION;
      const posted = isSection ? this.#sectionSize(interpreter, value) : value;
      this.#post(frame, kind, index, posted, other);
    }
  }

  /** Give the interpreter the values that others have set. @param {Interpreter} interpreter */
  #learnValues(interpreter) {
    const { values } = interpreter;
    for (const { address, index } of FREE) {
      if (this.#isRecent(index)) continue;
      const wasSet = this.#news(address, index);
      if (wasSet !== undefined && index !== SECTION) {
        this.#lastSet.set(index, wasSet);
        // Notes to come begin with it; its effect now, others have requested already.
        if (interpreter.isTarget(index)) interpreter.take(--this.#now, SET, index, wasSet, 0);
        else values[index] = wasSet;
        this.#sink.follow?.(index, wasSet);
      }
      const reported = this.#sink.reported?.(address);
      if (reported !== undefined) values[index] = reported;
    }
  }

  /**
   * What others have set a parameter to since this page knew; undefined: nothing.
   * @param {string} address
   * @param {number} index
   */
  #news(address, index) {
    const wasSet = this.#sink.wasSet?.(address);
    return wasSet === this.#lastSet.get(index) ? undefined : wasSet;
  }

  /** Frames are of another sound from now on: what was written before is no longer on its way. */
  restartFrames() {
    for (const written of this.#written.values()) written.frame = -Infinity;
  }

  /**
   * Number of players of the section: the interpreter knows of one only.
   * @param {Interpreter} interpreter
   * @param {number} one
   */
  #sectionSize({ found, values }, one) {
    const { maxPlayers = 1 } = this.#sink;
    return maxPlayers > 1
      ? (values[SECTION] = Math.min(Math.round(found[SECTION]), maxPlayers))
      : one;
  }

  /**
   * @param {number | null} frame
   * @param {number} kind
   * @param {number} index
   * @param {number} value
   * @param {number} other
   */
  #post(frame, kind, index, value, other) {
    if (kind === WRITE) {
      this.#note(index, value, frame);
      this.#lastSet.set(index, value);
    }
    if (kind === DRAW) {
      this.#note(BOW_SPEED.index, value, frame);
      this.#note(BOW_FORCE.index, other, frame);
    }
    // Raw newtons are heard only without assist.
    if (kind === DRAW || (kind === WRITE && index === BOW_FORCE.index)) {
      this.#note(BOW_ASSIST.index, 0, frame);
    }
    this.#sink.post(frame, kind, index, value, other);
  }

  /**
   * @param {number} index
   * @param {number} value
   * @param {number | null} frame
   */
  #note(index, value, frame) {
    this.#written.set(index, { value, frame: frame ?? this.#frame });
  }

  /**
   * Whether a parameter was written so lately that the sound may not report it yet.
   * @param {number} index
   */
  #isRecent(index) {
    const written = this.#written.get(index);
    return (
      written !== undefined &&
      this.#frame < written.frame + REPORTED_WITHIN_S * (this.#sink.rate ?? 0)
    );
  }

  /**
   * The value of a parameter, or the one it is moving to. Throws ParameterError where there is
   * none.
   * @param {string} address
   * @returns {number}
   */
  value(address) {
    const param = find(address);
    const { index, playerControlled } = param;
    const known = playerControlled
      ? this.#written.get(index)?.value
      : this.interpreter?.values[index];
    const reported = playerControlled
      ? this.#sink.target?.(address)
      : (this.#sink.reported?.(address) ?? this.#news(address, index));
    return (this.#isRecent(index) ? known : (reported ?? known)) ?? param.default;
  }

  /**
   * Set a parameter, until a controller moves it.
   * @param {number | null} frame
   * @param {import('./table.js').Param} param
   * @param {number} value within its range
   * @param {number} glideMs least time of the moves that follow
   */
  set(frame, { index }, value, glideMs) {
    const { interpreter } = this;
    if (interpreter && index === SECTION && (this.#sink.maxPlayers ?? 1) > 1) {
      interpreter.found[SECTION] = value;
      this.#post(frame, WRITE, SECTION, this.#sectionSize(interpreter, 1), 0);
    } else this.take(frame, SET, index, value, glideMs);
  }

  /**
   * Take another mapping while notes sound.
   * @param {number | null} frame
   * @param {Mapping} mapping
   * @param {Tuning} tuning
   */
  remap(frame, mapping, tuning) {
    if (this.interpreter === null) return;
    const { nextSlot } = this.interpreter;
    writeTables(this.interpreter.tables(nextSlot), mapping, tuning);
    this.take(frame, TABLES_TO, nextSlot);
  }

  /** Tune keys, from the next note on. @param {Tuning} tuning */
  tune(tuning) {
    if (this.interpreter) writeTuning(this.interpreter.tables(), tuning);
  }

  /**
   * End all that sounds, at once, whoever plays; also without an interpreter.
   * @param {number | null} frame
   */
  stop(frame) {
    if (this.interpreter) this.take(frame, STOP, 0, 1);
    else this.#post(frame, STOP, 0, 1, 0);
  }
}
