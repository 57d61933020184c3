/**
 * Posts what is wished of the player: the only way from the page to bow and fingers.
 *
 * The player decides in the audio callback. What it will do follows from the wishes, so that
 * parameters and held keys can be told at once, in the order of posting.
 */

import facts from '../facts.js';
import { roundHalfEven } from './numbers.js';
import { fit } from './range_policy.js';
import { TABLE, accept, find } from './table.js';

const { WRITE, HOLD, EXPRESS, BEGIN, END, SLIDE, DRAW, LIFT, STOP, RELEASE } = facts.kinds;
// Within this time the sound has a write, and tells the value that it moves to.
const TOLD_WITHIN_S = 0.1;

/**
 * @typedef {import('./keys.js').Key} Key
 * @typedef {import('./range_policy.js').RangePolicy} RangePolicy
 * @typedef {import('./target_values.js').Values} Values
 *
 * @typedef {object} Sink What wishes are posted to.
 * @property {(frame: number | null, kind: number, index: number, value: number, other: number)
 *   => unknown} post one wish; frame null is now
 * @property {number} [frame] number of the next sample, as far as the page knows
 * @property {number} [rate] Hz
 * @property {number} [seed] of the variation between notes
 * @property {(address: string) => number | undefined} [target] where a parameter of bow and
 *   fingers moves to
 * @property {number} [people] how many may play it; by default one
 * @property {(address: string) => number | undefined} [told] the value of any other parameter, where
 *   others set them too
 */

/** Asks the player of an instrument for notes and parameters. */
export class Wishes {
  #sink;
  #policy;
  #tuning;
  /** @type {Map<string, number>} */
  #value = new Map();
  /** @type {Set<string>} */
  #kept = new Set();
  /** Direct writes to bow and fingers, and what others may set too. @type {Map<string, {value: number, frame: number}>} */
  #written = new Map();
  /** Held keys in the order pressed, and the frame each begins at. @type {Map<Key, number>} */
  #held = new Map();
  /** @type {Key | null} */
  #sounding = null;

  /**
   * @param {Sink} sink
   * @param {RangePolicy} policy what happens to notes out of range
   * @param {(key: Key) => number | null} tuning the pitch of a key; null: it has none
   */
  constructor(sink, policy = 'transpose', tuning = (key) => key.note) {
    this.#sink = sink;
    this.#policy = policy;
    this.#tuning = tuning;
    for (const param of TABLE) {
      if (!param.owned) this.#value.set(param.address, param.default);
    }
    const seed = find('/engine/seed');
    this.#value.set(seed.address, accept(seed, sink.seed ?? seed.default));
  }

  get #frame() {
    return this.#sink.frame ?? 0;
  }

  // -- parameters --------------------------------------------------------------------------

  /**
   * The value of a parameter; one of bow and fingers may be moving to it.
   * @param {string} address
   * @returns {number}
   */
  value(address) {
    const own = this.#value.get(address);
    if (own === undefined) return this.#owned(find(address));
    return this.#isRecent(address) ? own : (this.#sink.told?.(address) ?? own);
  }

  /**
   * Whether a parameter was written so lately that the sound may not tell it yet.
   * @param {string} address
   */
  #isRecent(address) {
    const written = this.#written.get(address);
    if (written === undefined) return false;
    return this.#frame < written.frame + TOLD_WITHIN_S * (this.#sink.rate ?? 0);
  }

  /**
   * A value as just written, until the sound tells it.
   * @param {import('./table.js').Param} param
   * @returns {number}
   */
  #owned(param) {
    const written = this.#written.get(param.address);
    const told = this.#sink.target?.(param.address);
    if (written === undefined) return told ?? param.default;
    return this.#isRecent(param.address) ? written.value : (told ?? written.value);
  }

  /**
   * Set any parameter of the table; return the value it then has. Throws ParameterError where the
   * address is unknown or the value is not finite.
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   * @param {number} glideMs the moves of bow and fingers that follow take at least so long
   * @param {boolean} hold whether it is kept through notes, and not changed by other writes
   * @returns {number}
   */
  write(address, value, frame = null, glideMs = 0, hold = false) {
    const param = find(address);
    let accepted = accept(param, value);
    if (address === '/playing/section') {
      accepted = Math.min(roundHalfEven(accepted), this.#sink.people ?? 1);
    }
    if (param.owned) {
      this.#note(address, accepted, frame);
      // Raw newtons are heard only without assist.
      if (address === '/bow/force') this.#note('/bow/assist', 0, frame);
    } else if (this.#kept.has(address) && !hold) {
      return this.value(address);
    } else {
      this.#value.set(address, accepted);
      if (this.#sink.told) this.#note(address, accepted, frame);
    }
    if (hold) this.#kept.add(address);
    this.#sink.post(frame, hold ? HOLD : WRITE, param.row, accepted, glideMs);
    return accepted;
  }

  /**
   * @param {string} address
   * @param {number} value
   * @param {number | null} frame
   */
  #note(address, value, frame) {
    this.#written.set(address, { value, frame: frame ?? this.#frame });
  }

  /**
   * Return every parameter that was taken over to the player.
   * @param {number | null} frame
   */
  release(frame = null) {
    this.#kept.clear();
    this.#sink.post(frame, RELEASE, 0, 0, 0);
  }

  /**
   * Whether a parameter was written to be held.
   * @param {string} address
   * @returns {boolean}
   */
  keeps(address) {
    return this.#kept.has(address);
  }

  // -- notes -------------------------------------------------------------------------------

  /** The key whose note sounds, if any. @returns {Key | null} */
  get sounding() {
    return this.#sounding;
  }

  /**
   * Whether a key is held.
   * @param {Key} key
   * @returns {boolean}
   */
  holds(key) {
    return this.#held.has(key);
  }

  /**
   * The held keys, of one channel or all, in the order pressed.
   * @param {number | null} channel
   * @returns {Key[]}
   */
  held(channel = null) {
    const keys = [...this.#held.keys()];
    return channel === null ? keys : keys.filter((key) => key.channel === channel);
  }

  /**
   * Whether the instrument has a note for a key.
   * @param {Key} key
   * @returns {boolean}
   */
  has(key) {
    return this.#pitch(key) !== null;
  }

  /** @param {Key} key */
  #pitch(key) {
    const tuned = this.#tuning(key);
    return tuned === null ? null : fit(this.#policy, tuned);
  }

  /**
   * Begin a note, legato where another sounds, else with a new stroke of the bow.
   *
   * Keys struck at one frame make one stroke. Returns whether the instrument has the note.
   * @param {Key} key
   * @param {Values | null} values of parameters, for this note
   * @param {number | null} frame
   * @returns {boolean}
   */
  noteOn(key, values = null, frame = null) {
    const pitch = this.#pitch(key);
    if (pitch === null) return false;
    this.#held.delete(key);
    this.#held.set(key, frame ?? this.#frame);
    this.#sounding = key;
    this.#express(values, frame);
    this.#sink.post(frame, BEGIN, key.channel, key.note, pitch);
    return true;
  }

  /**
   * The key that will sound again when these end; null where none will.
   * @param {readonly Key[]} keys
   * @returns {Key | null}
   */
  heir(keys) {
    if (this.#sounding === null || !keys.includes(this.#sounding)) return null;
    return this.held().findLast((key) => !keys.includes(key)) ?? null;
  }

  /**
   * End several notes at once; of those still held the last one sounds again, legato.
   * @param {readonly Key[]} keys
   * @param {Values | null} values of parameters, for the note that sounds again; see `heir`
   * @param {number | null} frame
   */
  notesOff(keys, values = null, frame = null) {
    const ending = [...new Set(keys)];
    let at = frame;
    // A note whose end comes before its beginning, as it was asked for ahead, ends as it begins.
    for (const key of ending) {
      const begun = this.#held.get(key);
      this.#held.delete(key);
      if (begun !== undefined && begun > (at ?? this.#frame)) at = begun;
    }
    if (this.#sounding !== null && ending.includes(this.#sounding)) {
      this.#sounding = this.held().at(-1) ?? null;
      if (this.#sounding !== null) this.#express(values, at);
    }
    ending.forEach((key, number) => {
      const more = number < ending.length - 1 ? 1 : 0;
      this.#sink.post(at, END, key.channel, key.note, more);
    });
  }

  /**
   * @param {Values | null} values
   * @param {number | null} frame
   */
  #express(values, frame) {
    for (const [address, value] of values ?? []) {
      if (!this.#kept.has(address)) {
        const param = find(address);
        const accepted = accept(param, value);
        this.#value.set(address, accepted);
        this.#sink.post(frame, EXPRESS, param.row, accepted, 0);
      }
    }
  }

  /**
   * Lift bow and fingers and stop the sound at once, unless a note sounds. In a panic also what
   * sounds ends, whatever is known of it here.
   * @param {number | null} frame
   * @param {boolean} isPanic
   */
  stopSound(frame = null, isPanic = false) {
    if (isPanic || this.#sounding === null) this.#sink.post(frame, STOP, 0, isPanic ? 1 : 0, 0);
  }

  // -- by hand -----------------------------------------------------------------------------

  /**
   * Slide the finger to a pitch (fractional MIDI note); return the pitch within range.
   *
   * The sounding note slides; in silence, the finger waits there for the bow.
   * @param {number} pitch
   * @param {number | null} frame
   * @returns {number}
   */
  slide(pitch, frame = null) {
    const within = fit('clamp', pitch) ?? pitch;
    this.#sink.post(frame, SLIDE, 0, within, 0);
    return within;
  }

  /**
   * Draw the bow by hand at a speed (m/s) and force (N), on the string of the fingering.
   *
   * Takes the bow over as direct writes do; 0 and 0 lift it. Returns both as accepted.
   * @param {number} speed
   * @param {number} force
   * @param {number | null} frame
   * @returns {[number, number]}
   */
  draw(speed, force, frame = null) {
    const drawn = accept(find('/bow/speed'), speed);
    const pressed = accept(find('/bow/force'), force);
    this.#note('/bow/speed', drawn, frame);
    this.#note('/bow/force', pressed, frame);
    this.#note('/bow/assist', 0, frame);
    this.#sink.post(frame, DRAW, 0, drawn, pressed);
    return [drawn, pressed];
  }

  /**
   * Lift a bow drawn by hand, and return it to the player.
   * @param {number | null} frame
   */
  lift(frame = null) {
    this.#sink.post(frame, LIFT, 0, 0, 0);
  }
}
