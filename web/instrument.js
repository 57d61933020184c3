/** The instrument of this page: its sound, once it is open, and its player. */

/** @typedef {import('./interfaces.js').Sound} Sound */
/** @typedef {import('./interfaces.js').Post} Post */
/** @typedef {import('./playing/learned.js').Mapping} Mapping */
/** @typedef {import('./playing/part.js').Sink} Sink */

import facts from "./facts.js";
import { Interpreter } from "./playing/interpreter.js";
import { MAPPINGS } from "./playing/learned.js";
import { Player } from "./playing/player.js";

/** Commands before the sound is open wait for it; more than these are of no use to anybody. */
const MAX_WAITING = 1000;
const PREPARING = 503;
const AHEAD_S = 0.25;
const AHEAD_HIDDEN_S = 1.5;

/**
 * Events: 'prepare' while a server prepares what the page plays by, 'ready' once it can be
 * played, 'lack' when it cannot (with the error as `error`); 'start' when it sounds, 'fail' when it
 * cannot; 'way' when it is to sound in another one; 'state' of each new snapshot; 'silence' when all has to end, and 'command' of each command (a `CustomEvent<Command>`).
 *
 * @typedef {object} Command
 * @property {number} frame
 * @property {number} kind
 * @property {number} index
 * @property {number} value
 * @property {number} other
 */
export class Instrument extends EventTarget {
  constructor() {
    super();
    /** @type {Sound | null} */
    this.sound = null;
    this.isSeen = false;
    /** @type {Promise<unknown> | null} */
    this.opening = null;
    /** @type {unknown} */
    this.error = null;
    /** What others have set who play the same. @type {{wasSet: Sink["wasSet"]} | null} */
    this.others = null;
    /** A sound of this page, which may be opened before it is asked for. @type {Promise<Sound> | null} */
    this.here = null;
    /** How the sound is opened; `change` takes another way. @type {() => Promise<Sound | void>} */
    this.way = () => this.openHere();
    /** @type {Parameters<Post>[]} */
    this.waiting = [];
    this.player = new Player(this);
    /** The instrument in WebAssembly: the page plays by it, and may sound by it. */
    this.module = fetchModule(() => this.dispatchEvent(new Event("prepare")));
    this.#prepare();
    /** What controllers move while no tune brings its own. @type {Mapping} */
    this.mapping = MAPPINGS[facts.defaultMapping];
  }

  async #prepare() {
    try {
      this.player.playBy(await Interpreter.open(await this.module));
      this.dispatchEvent(new Event("ready"));
    } catch (error) {
      this.error = error;
      this.dispatchEvent(new Event("lack"));
    }
  }

  // What the player asks of it, besides `post` and `frame` (its `Sink`).

  /** @param {string} address */
  target = (address) => this.sound?.target?.(address);
  /** @param {string} address */
  reported = (address) => this.sound?.reported?.(address);
  /** @param {string} address */
  wasSet = (address) => this.others?.wasSet?.(address);

  /** Take what others have set. @param {number} index @param {number} value */
  follow(index, value) {
    if (!this.sound?.reported) this.sound?.post(null, facts.kinds.WRITE, index, value, 0);
  }

  get maxPlayers() {
    return this.sound?.maxPlayers;
  }

  get rate() {
    return this.sound?.status.rate ?? 0;
  }

  /** Number of the sample at which a command is applied now, about. */
  get frame() {
    return this.sound?.frame ?? this.state?.frame ?? 0;
  }

  /**
   * Frame until which timed messages should be given to the player by now: a little ahead, and
   * more in a hidden page, which is woken once a second only.
   */
  get horizon() {
    return this.frame + Math.round(this.rate * (document.hidden ? AHEAD_HIDDEN_S : AHEAD_S));
  }

  /** The latest snapshot, or null before the first. */
  get state() {
    return this.isSeen && this.sound ? this.sound.state : null;
  }

  /** @type {Post} */
  post(frame, kind, index, value, other) {
    if (this.sound) this.sound.post(frame, kind, index, value, other);
    else if (this.waiting.length < MAX_WAITING)
      this.waiting.push([null, kind, index, value, other]);
    this.dispatchEvent(
      new CustomEvent("command", {
        detail: { frame: frame ?? this.frame, kind, index, value, other },
      }),
    );
  }

  /** Open the sound, at most once; a browser lets it sound after a touch only. */
  start() {
    if (this.sound && !this.sound.status.running) this.sound.resume?.();
    this.opening ??= this.#open();
    return this.opening;
  }

  /** Load all that a sound of this page needs, so that the first touch is heard at once. */
  prepareHere() {
    this.here ??= this.openHere();
    this.here.catch(() => (this.here = null)); // reported when it is started
  }

  /**
   * Sound in another way from now on; it begins when it is started, or was already.
   * @param {() => Promise<Sound | void>} way
   */
  change(way) {
    this.dispatchEvent(new Event("silence"));
    if (this.sound) this.player.endNotes(null, false); // only what this page holds
    this.player.restartFrames();
    this.waiting.length = 0;
    const isAwaited = this.opening !== null && this.sound === null;
    this.sound?.close();
    this.sound = this.opening = null;
    this.isSeen = false;
    this.way = way;
    this.dispatchEvent(new Event("way"));
    if (isAwaited) this.start(); // whoever has asked for a sound gets that of the new way
  }

  /** End all that plays or sounds. */
  silence() {
    this.dispatchEvent(new Event("silence")); // tunes and hands end first
    this.player.panic();
  }

  /**
   * Open a sound of this page.
   * @returns {Promise<Sound>}
   */
  async openHere() {
    const { here } = this;
    this.here = null; // whoever gets it may close it
    if (here) return here;
    const { Sound } = await import("./sound/sound.js");
    return Sound.open(this.module);
  }

  async #open() {
    const { way } = this;
    try {
      const sound = await way();
      if (way !== this.way) {
        sound?.close(); // another way was chosen meanwhile
        return this.opening;
      }
      if (!sound) throw new Error("nothing sounds");
      sound.addEventListener("state", () => {
        if (this.sound !== sound) return;
        this.isSeen = true;
        this.dispatchEvent(new Event("state"));
      });
      this.sound = sound;
      sound.resume?.();
      for (const command of this.waiting.splice(0)) sound.post(...command);
      this.error = null;
      this.dispatchEvent(new Event("start"));
    } catch (error) {
      if (way !== this.way) return this.opening;
      this.error = error;
      this.opening = null; // another touch may try again
      this.dispatchEvent(new Event("fail"));
    }
  }
}

/**
 * The instrument in WebAssembly, which a server may still be preparing. Throws an error that says why there is none.
 * @param {() => void} waits called whenever it is still being prepared
 * @returns {Promise<ArrayBuffer>}
 */
async function fetchModule(waits) {
  for (;;) {
    const answer = await fetch(new URL("yehu.wasm", import.meta.url));
    if (answer.ok) return answer.arrayBuffer();
    const seconds = Number(answer.headers.get("Retry-After"));
    if (answer.status !== PREPARING || !seconds) throw new Error(await reasonOf(answer));
    waits();
    await new Promise((resolve) => setTimeout(resolve, 1e3 * seconds));
  }
}

/**
 * Why there is none: a server of this instrument says it, others have their own pages for that.
 * @param {Response} answer
 */
async function reasonOf(answer) {
  const isReason = answer.headers.get("Content-Type")?.startsWith("text/plain");
  return isReason ? (await answer.text()).trim() : `${answer.status} ${answer.statusText}`;
}
