/** Where each source was last moved to, on each channel. */

import { DefaultMap } from './default_map.js';
import { NOTE, POLY_PRESSURE, STEPS, VELOCITY, isOfOneNote } from './sources.js';

/**
 * @typedef {import('./binds.js').Bind} Bind
 * @typedef {import('./mapping.js').Mapping} Mapping
 *
 * @typedef {object} Move One move.
 * @property {number} number its running number, by which the later of two counts
 * @property {number} position 0 to 1
 *
 * @typedef {object} NoteMoves Those of a note that had this key before.
 * @property {Move | undefined} velocity
 * @property {Move | undefined} polyPressure
 */

/** The last moves on one channel. */
export class ChannelMoves {
  constructor() {
    /** @type {Map<string, Move>} */
    this.sources = new Map();
    /** Moves that soft binds have acted on, by the key of the bind. @type {Map<string, Move>} */
    this.soft = new Map();
    /** By note. @type {Map<number, Move>} */
    this.polyPressure = new Map();
    /** By note. @type {Map<number, Move>} */
    this.velocity = new Map();
  }

  /**
   * The move that a bind acts on, for a note.
   * @param {Bind} bind
   * @param {number} note
   * @returns {Move | undefined}
   */
  of(bind, note) {
    if (bind.source === POLY_PRESSURE) return this.polyPressure.get(note);
    if (bind.source === VELOCITY) return this.velocity.get(note);
    if (bind.source === NOTE) {
      const struck = this.velocity.get(note);
      return struck && { number: struck.number, position: note / STEPS };
    }
    return bind.isSoft ? this.soft.get(bind.key) : this.sources.get(bind.source);
  }

  /**
   * The moves of a bind's source, of all notes.
   * @param {Bind} bind
   * @returns {Move[]}
   */
  ofAnyNote(bind) {
    if (bind.source === POLY_PRESSURE) return [...this.polyPressure.values()];
    if (bind.source === VELOCITY) return [...this.velocity.values()];
    if (bind.source === NOTE) {
      const struck = [...this.velocity];
      return struck.map(([note, move]) => ({ number: move.number, position: note / STEPS }));
    }
    const move = this.sources.get(bind.source);
    return move === undefined ? [] : [move];
  }

  /**
   * Give a new note its velocity; return what `cancelNote` needs.
   * @param {number} note
   * @param {Move} velocity
   * @returns {NoteMoves}
   */
  beginNote(note, velocity) {
    const before = { velocity: this.velocity.get(note), polyPressure: this.polyPressure.get(note) };
    this.polyPressure.delete(note);
    this.velocity.set(note, velocity);
    return before;
  }

  /**
   * Undo `beginNote`.
   * @param {number} note
   * @param {NoteMoves} before
   */
  cancelNote(note, before) {
    restore(this.velocity, note, before.velocity);
    restore(this.polyPressure, note, before.polyPressure);
  }

  /**
   * The moves of the sources of some binds.
   * @param {readonly Bind[]} binds
   * @returns {ChannelMoves}
   */
  only(binds) {
    const kept = new ChannelMoves();
    for (const bind of binds) {
      restore(kept.sources, bind.source, this.sources.get(bind.source));
      restore(kept.soft, bind.key, this.soft.get(bind.key));
    }
    return kept;
  }

  /**
   * Keep the moves of sources that another mapping binds too.
   * @param {Mapping} before
   * @param {Mapping} after
   */
  remap(before, after) {
    this.soft = this.#softOf(before, after);
    for (const source of this.sources.keys()) {
      if (after.of(source).length === 0) this.sources.delete(source);
    }
    if (after.of(POLY_PRESSURE).length === 0) this.polyPressure.clear();
  }

  /**
   * Moves of the new soft binds, where their source moved the same target before.
   * @param {Mapping} before
   * @param {Mapping} after
   * @returns {Map<string, Move>}
   */
  #softOf(before, after) {
    const found = new Map();
    for (const bind of after.binds) {
      for (const old of bind.isSoft ? before.of(bind.source) : []) {
        const move = old.isSoft ? this.soft.get(old.key) : this.sources.get(old.source);
        if (old.target === bind.target && move !== undefined) found.set(bind.key, move);
      }
    }
    return found;
  }
}

/**
 * Put a move back where it was; without one, there was none.
 * @template K
 * @param {Map<K, Move>} moves
 * @param {K} key
 * @param {Move | undefined} move
 */
function restore(moves, key, move) {
  if (move === undefined) moves.delete(key);
  else moves.set(key, move);
}

/** The last moves on all channels, counted from 0 over all ports. */
export class Moves {
  /** @type {DefaultMap<number, ChannelMoves>} */
  #channels = new DefaultMap(() => new ChannelMoves());
  #count = 0;

  /**
   * The moves on a channel.
   * @param {number} channel
   * @returns {ChannelMoves}
   */
  on(channel) {
    return this.#channels.at(channel);
  }

  /** The channels on which something was moved. @returns {Iterable<number>} */
  get channels() {
    return this.#channels.keys();
  }

  /** The number of a new move, or of a direct write. */
  nextNumber() {
    this.#count += 1;
    return this.#count;
  }

  /**
   * A new move.
   * @param {number} position
   * @returns {Move}
   */
  to(position) {
    return { number: this.nextNumber(), position };
  }

  /**
   * The move that a bind acts on, for a note of a channel.
   * @param {Bind} bind
   * @param {number} channel
   * @param {number} note
   * @returns {Move | undefined}
   */
  of(bind, channel, note) {
    return bind.receives(channel) ? this.on(channel).of(bind, note) : undefined;
  }

  /**
   * The channel, of some, with the latest move that a bind acts on; null where none has one.
   * @param {Bind} bind
   * @param {readonly number[]} channels
   * @returns {number | null}
   */
  latest(bind, channels) {
    if (isOfOneNote(bind.source)) return null;
    let found = null;
    let number = 0;
    for (const channel of channels) {
      const move = this.of(bind, channel, -1);
      if (move !== undefined && move.number > number) {
        found = channel;
        number = move.number;
      }
    }
    return found;
  }

  /**
   * Where a bind's source was last moved to, on any channel that the bind receives.
   * @param {Bind} bind
   * @returns {number | null}
   */
  position(bind) {
    /** @type {Move | null} */
    let last = null;
    for (const [channel, own] of this.#channels) {
      for (const move of bind.receives(channel) ? own.ofAnyNote(bind) : []) {
        if (last === null || move.number > last.number) last = move;
      }
    }
    return last === null ? null : last.position;
  }

  /**
   * Forget the moves of a channel; return them.
   * @param {number} channel
   * @returns {ChannelMoves}
   */
  pop(channel) {
    const own = this.#channels.get(channel) ?? new ChannelMoves();
    this.#channels.delete(channel);
    return own;
  }

  /**
   * Give a channel other moves.
   * @param {number} channel
   * @param {ChannelMoves} moves
   */
  put(channel, moves) {
    this.#channels.set(channel, moves);
  }

  /** Forget all moves. */
  clear() {
    this.#channels.clear();
  }

  /**
   * See `ChannelMoves.remap`.
   * @param {Mapping} before
   * @param {Mapping} after
   */
  remap(before, after) {
    for (const own of this.#channels.values()) own.remap(before, after);
  }
}
