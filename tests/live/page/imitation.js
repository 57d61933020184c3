/**
 * Imitates the sound of the page, in place of `web/sound/sound.js`: it makes no sound, but
 * snapshots of an ideal string in Helmholtz motion, by the commands it is given, which it keeps.
 */

import facts from "../facts.js";

/** @typedef {import("../../../web/interfaces.js").Snapshot} Snapshot */

const { BEGIN, END, SLIDE, DRAW, LIFT, STOP, WRITE, HOLD } = facts.kinds;
const RATE = 48000;
const POINTS = 64;
const LENGTH = 0.38; // m
const LIMIT = 7.3; // Schelleng's greatest force, for each m/s at a beta of 0.13
const OPEN = facts.notes.OPEN;
const INDEX = new Map(facts.parameters.map(({ address, index }) => [address, index]));

export class Sound extends EventTarget {
  static async open() {
    return new Sound();
  }

  constructor() {
    super();
    /** @type {[number, number, number, number, number][]} kind, index, value, other, frame */
    this.commands = [];
    /** @type {{key: string, pitch: number}[]} */
    this.notes = [];
    this.values = new Map(facts.parameters.map((param) => [param.index, param.default]));
    this.pitch = NaN;
    this.drawn = { isOn: false, speed: 0, force: 0 };
    this.begun = performance.now();
    this.phase = 0;
    this.time = 0;
    this.status = {
      backend: /** @type {const} */ ("worklet"),
      rate: RATE,
      loadPercent: 3,
      latencyMs: 12,
      dropouts: 0,
      running: true,
    };
    const context = new OfflineAudioContext(1, RATE, RATE);
    this.analyser = imitateAnalyser(context, () => this.state);
    /** What was begun and ended, in order, of any sound. @type {string[]} */
    this.done = globalThis.done ??= [];
    this.record = {
      start: () => this.done.push("record"),
      stop: () => {
        this.done.push("recorded");
        return new Blob(["RIFF"], { type: "audio/wav" });
      },
    };
    this.voice = {
      follow: () => {},
      start: async () => {
        await globalThis.agreed;
        this.done.push("voice");
      },
      stop: () => this.done.push("silent"),
    };
    /** @type {number[]} */
    this.kept = [];
    this.keep = {
      start: () => {
        this.done.push("keep");
        this.kept = [];
        this.keptFrom = this.state?.frame ?? 0;
      },
      stop: async () => ({
        from: this.keptFrom,
        to: this.#frame(),
        commands: this.kept,
      }),
    };
    this.keptFrom = 0;
    this.state = this.#snapshot();
    const tick = () => {
      this.state = this.#snapshot();
      this.dispatchEvent(new Event("state"));
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
    Object.assign(globalThis, { imitation: this });
  }

  close() {}

  /** @type {import("../../../web/interfaces.js").Post} */
  post(frame, kind, index, value, other) {
    const at = frame ?? this.state?.frame ?? 0;
    this.commands.push([kind, index, value, other, at]);
    this.kept.push(at, kind, index, value, other);
    const key = `${index} ${value}`;
    if (kind === BEGIN) {
      this.notes.push({ key, pitch: other });
      this.pitch = other;
    } else if (kind === END) {
      this.notes = this.notes.filter((note) => note.key !== key);
      this.pitch = this.notes.at(-1)?.pitch ?? this.pitch;
    } else if (kind === SLIDE) this.pitch = value;
    else if (kind === DRAW) this.drawn = { isOn: true, speed: value, force: other };
    else if (kind === LIFT) this.drawn = { isOn: false, speed: 0, force: 0 };
    else if (kind === STOP) this.notes = [];
    else if (kind === WRITE || kind === HOLD) this.values.set(index, value);
  }

  /** @param {string} address */
  target(address) {
    return this.values.get(INDEX.get(address) ?? -1);
  }

  /** The frame that is played now; those of the states are some milliseconds old. */
  #frame() {
    return Math.round(((performance.now() - this.begun) / 1000) * RATE);
  }

  /** @returns {Snapshot} */
  #snapshot() {
    const time = (performance.now() - this.begun) / 1000;
    const isBowed = this.drawn.isOn || this.notes.length > 0;
    const beta = this.values.get(INDEX.get("/playing/bow_position") ?? -1) ?? 0.13;
    const share = this.values.get(INDEX.get("/playing/pressure") ?? -1) ?? 0.4;
    const speed = this.drawn.isOn
      ? this.drawn.speed
      : isBowed
        ? 0.2 * Math.sign(Math.sin(time * 3))
        : 0;
    const max = (LIMIT * Math.abs(speed) * 0.13) / beta;
    const min = (0.22 * Math.abs(speed) * 0.13 ** 2) / beta ** 2;
    const force = this.drawn.isOn ? this.drawn.force : share * max * (1 + 0.1 * Math.sin(time * 7));
    const pitch = isBowed && !Number.isNaN(this.pitch) ? this.pitch : NaN;
    const string = pitch >= OPEN[1] ? 1 : 0;
    const stop = isBowed ? LENGTH * (1 - 2 ** ((OPEN[string] - (pitch || OPEN[string])) / 12)) : 0;
    const period = 1 / (440 * 2 ** (((pitch || 69) - 69) / 12));
    this.phase = (this.phase + (time - this.time) / period) % 1;
    this.time = time;
    const isSounding = isBowed && Math.abs(speed) > 0.01 && force < 1.5 * max && force > min;
    /** @type {[Float32Array, Float32Array]} */
    const shape = [new Float32Array(POINTS), new Float32Array(POINTS)];
    if (isSounding) helmholtz(shape[string], this.phase, stop / LENGTH, 0.8e-3 * Math.sign(speed));
    return {
      frame: Math.round(time * RATE),
      time,
      pitch,
      heard: {
        certainty: isSounding ? 0.97 : 0.2,
        errorCents: 4 * Math.sin(time * 2),
        slips: force < min ? 2 : 1,
      },
      level: isSounding ? -12 + 2 * Math.sin(time) : -90,
      shape,
      bow: {
        string: isBowed ? string : -1,
        speed,
        force,
        beta,
        x: LENGTH - beta * (LENGTH - stop),
      },
      hair: { place: 0.35 + 0.3 * Math.cos(time * 3), length: 0.7 },
      fingers: stop > 0.01 ? [{ x: stop, press: 1.5, string }] : [],
      period,
      string: { length: LENGTH },
      schelleng: { min, max },
    };
  }
}

/**
 * The ideal motion: two straight lines that meet in a corner, which runs around the sounding part.
 * @param {Float32Array} shape
 * @param {number} phase
 * @param {number} stop where the sounding part begins, as a share of the length
 * @param {number} swing m
 */
function helmholtz(shape, phase, stop, swing) {
  const isBack = phase > 0.5;
  const corner = isBack ? 2 - 2 * phase : 2 * phase;
  const height = (isBack ? -1 : 1) * swing * 4 * corner * (1 - corner);
  for (let i = 0; i < POINTS; i++) {
    const x = (i / (POINTS - 1) - stop) / (1 - stop);
    if (x <= 0) continue;
    shape[i] = height * Math.min(x / Math.max(corner, 1e-6), (1 - x) / Math.max(1 - corner, 1e-6));
  }
}

/**
 * Looks like an analyser that hears a sawtooth of the pitch.
 * @param {BaseAudioContext} context
 * @param {() => Snapshot} state
 */
function imitateAnalyser(context, state) {
  const analyser = context.createAnalyser();
  analyser.fftSize = 4096;
  analyser.getFloatFrequencyData = (levels) => {
    const { pitch, level } = state();
    const step = RATE / 4096;
    levels.fill(-110);
    if (level < -80) return;
    const fundamental = 440 * 2 ** ((pitch - 69) / 12);
    for (let bin = 0; bin < levels.length; bin++) {
      const n = Math.max(1, Math.round((bin * step) / fundamental));
      const away = Math.abs(bin * step - n * fundamental) / step;
      levels[bin] = Math.max(-25 - 12 * Math.log2(n) - 3 * away ** 2, -95);
    }
  };
  return analyser;
}
