/** Begins and ends the notes of keys, as pedals and controllers have it. */

/**
 * @typedef {import('./keys.js').Key} Key
 * @typedef {import('./midi_channel.js').MidiChannel} MidiChannel
 */

/** The notes of all channels. */
export class Notes {
  #wishes;
  #controllers;
  #channels;
  #scope;

  /**
   * @param {import('./wishes.js').Wishes} wishes
   * @param {import('./controllers.js').Controllers} controllers
   * @param {import('./channels.js').Channels} channels
   * @param {import('./scope.js').Scope} scope
   */
  constructor(wishes, controllers, channels, scope) {
    this.#wishes = wishes;
    this.#controllers = controllers;
    this.#channels = channels;
    this.#scope = scope;
  }

  /**
   * Begin a note; `velocity` is 0 to 1.
   * @param {Key} key
   * @param {number} velocity
   * @param {number | null} frame
   */
  on(key, velocity, frame) {
    const state = this.#channels.at(key.channel);
    const isSustained = this.#takeFromPedals(key);
    if (this.#wishes.holds(key) && !isSustained && frame !== null) {
      state.retriggered.set(key.note, frame);
    }
    const isFirst = this.#scope.add(key.channel);
    const before = this.#controllers.beginNote(key, velocity);
    const values = this.#wishes.has(key) ? this.#controllers.valuesOf(key) : null;
    if (this.#wishes.noteOn(key, values, frame)) return;
    this.#controllers.cancelNote(key, before);
    if (isFirst) this.#scope.remove(key.channel);
  }

  /**
   * Let no pedal hold a key any more; return whether one did.
   * @param {Key} key
   * @returns {boolean}
   */
  #takeFromPedals(key) {
    let wasHeld = false;
    for (const [, state] of this.#channels.states) wasHeld = state.sustained.delete(key) || wasHeld;
    return wasHeld;
  }

  /**
   * End a note, unless a pedal keeps it.
   * @param {Key} key
   * @param {number | null} frame
   */
  off(key, frame) {
    const { retriggered } = this.#channels.at(key.channel);
    if (frame !== null) {
      const struckAgain = retriggered.get(key.note);
      retriggered.delete(key.note);
      // The note-off of the note before, which some files write after the new note-on.
      if (struckAgain === frame) return;
    }
    this.#release([key], frame);
  }

  /**
   * End the notes of released keys, except those that a pedal holds.
   * @param {Iterable<Key>} keys
   * @param {number | null} frame
   */
  #release(keys, frame) {
    const ended = [];
    for (const key of keys) {
      const pedal = this.#pedal(key.channel);
      if (pedal === null) ended.push(key);
      else pedal.sustained.add(key);
    }
    this.#end(ended, frame);
  }

  /**
   * A channel whose pedal holds the notes of this one; null where none does.
   * @param {number} channel
   * @returns {MidiChannel | null}
   */
  #pedal(channel) {
    const master = this.#channels.master(channel);
    for (const [each, state] of this.#channels.states) {
      if (!state.sustain) continue;
      if (each === channel || each === master || this.#scope.isForAll(each)) return state;
    }
    return null;
  }

  /**
   * Lift the pedal of a channel, and end the notes that it held.
   * @param {MidiChannel} state
   * @param {number | null} frame
   */
  liftPedal(state, frame) {
    state.sustain = false;
    const { sustained } = state;
    state.sustained = new Set();
    this.#release(sustained, frame);
  }

  /**
   * Lift all pedals.
   * @param {number | null} frame
   */
  liftPedals(frame) {
    const states = this.#channels.states.map(([, state]) => state);
    for (const state of states) state.sustain = false;
    for (const state of states) this.liftPedal(state, frame);
  }

  /**
   * End notes at once; the one that sounds again does so with its own values.
   * @param {readonly Key[]} keys
   * @param {number | null} frame
   */
  #end(keys, frame) {
    const heir = this.#wishes.heir(keys);
    const values = heir === null ? null : this.#controllers.valuesOf(heir);
    this.#wishes.notesOff(keys, values, frame);
  }

  /**
   * End all notes, whatever pedals hold.
   * @param {number | null} frame
   */
  endAll(frame) {
    this.#end(this.#wishes.held(), frame);
  }

  /**
   * End the notes of a channel and those its pedal holds, and forget its state.
   * @param {number} channel
   * @param {number | null} frame
   */
  endChannel(channel, frame) {
    this.#end(this.#wishes.held(channel), frame);
    this.liftPedal(this.#channels.at(channel), frame);
    this.#channels.forget(channel);
  }

  /**
   * Act on "all sound off": end the notes of a channel or zone, those its pedal holds, and, where
   * none sounds then, the sound.
   * @param {number} channel
   * @param {number | null} frame
   */
  stopSound(channel, frame) {
    const { sustained } = this.#channels.at(channel);
    const zone = this.#channels.zone(channel);
    const elsewhere = [...sustained].filter((key) => !zone.includes(key.channel));
    sustained.clear();
    this.#end([...elsewhere, ...zone.flatMap((each) => this.#wishes.held(each))], frame);
    this.#wishes.stopSound(frame);
  }

  /**
   * Act on "all notes off": as if the keys of a channel or zone were released.
   * @param {number} channel
   * @param {number | null} frame
   */
  letGo(channel, frame) {
    const { sustain, sustained } = this.#channels.at(channel);
    const keys = this.#channels.zone(channel).flatMap((each) => this.#wishes.held(each));
    if (sustain) keys.forEach((key) => sustained.add(key));
    else this.#end(keys, frame);
  }
}
