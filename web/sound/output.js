/**
 * Plays a processor's sound: by an audio worklet, on a thread of its own; and where a
 * page has none, being loaded over plain http from another machine, by a script processor on the page's thread.
 */

import { CHANNELS } from "./kernel.js";

const FFT = 4096;
const SCRIPT_FRAMES = 512;
const FADE_S = 0.01;

/**
 * @typedef {object} Processor
 * @property {string} name that its worklet registers
 * @property {string} file of its worklet, beside this one
 * @property {object} options of the worklet
 * @property {number} [inputs] of sound
 * @property {(frames: number) => (left: Float32Array, right: Float32Array) => void} make the one for the page's
 *   own thread: what fills blocks of so many frames
 */

export class Output {
  /** @param {AudioContext} context */
  constructor(context) {
    this.context = context;
    this.analyser = new AnalyserNode(context, { fftSize: FFT, smoothingTimeConstant: 0.6 });
    this.gain = new GainNode(context, { gain: 1 });
    /** The worklet's port; null: it is on the page's thread. @type {MessagePort | null} */
    this.port = null;
    /** @type {AudioNode | null} */
    this.node = null;
  }

  /** Play a processor's sound. @param {Processor} processor */
  async connect({ name, file, options, inputs = 0, make }) {
    const { context } = this;
    if (context.audioWorklet) {
      await context.audioWorklet.addModule(new URL(file, import.meta.url));
      const node = new AudioWorkletNode(context, name, {
        numberOfInputs: inputs,
        outputChannelCount: [CHANNELS],
        processorOptions: options,
      });
      [this.node, this.port] = [node, node.port];
    } else {
      const node = context.createScriptProcessor(SCRIPT_FRAMES, 0, CHANNELS);
      const fill = make(SCRIPT_FRAMES);
      node.onaudioprocess = ({ outputBuffer }) =>
        fill(outputBuffer.getChannelData(0), outputBuffer.getChannelData(1));
      this.node = node;
    }
    this.node.connect(this.gain).connect(this.analyser).connect(context.destination);
  }

  get latencyMs() {
    const { baseLatency = 0, outputLatency = 0 } = this.context;
    return 1e3 * (baseLatency + outputLatency);
  }

  /** Fade out, and close all. */
  close() {
    const end = this.context.currentTime + FADE_S;
    this.gain.gain.linearRampToValueAtTime(0, end);
    setTimeout(() => {
      this.port?.postMessage({ close: true });
      this.node?.disconnect();
      this.context.close();
    }, 2e3 * FADE_S);
  }
}
