/** Hears the server: its sound comes by a WebSocket, and is played by the page. */

import { JitterBuffer } from "./jitter_buffer.js";
import { CHANNELS } from "./kernel.js";
import { socketUrl } from "./server_connection.js";

const FFT = 4096;
const SCRIPT_FRAMES = 512;
const FADE_S = 0.01;

export class StreamPlayer {
  /**
   * @param {number} rate of the server's sound, in Hz
   * @returns {Promise<StreamPlayer>}
   */
  static async open(rate) {
    const context = new AudioContext({ latencyHint: "interactive" });
    context.resume().catch(() => {}); // while the touch counts; another touch resumes it, too
    try {
      const listener = new StreamPlayer(context, rate);
      await listener.#connect();
      return listener;
    } catch (error) {
      await context.close();
      throw error;
    }
  }

  /** @param {AudioContext} context @param {number} rate of the server's sound, in Hz */
  constructor(context, rate) {
    this.context = context;
    this.rate = rate;
    this.analyser = new AnalyserNode(context, { fftSize: FFT, smoothingTimeConstant: 0.6 });
    this.gain = new GainNode(context, { gain: 1 });
    this.told = { fill: 0, gaps: 0 };
    this.worker = new Worker(new URL("./listening_worker.js", import.meta.url), { type: "module" });
  }

  async #connect() {
    const { port1, port2 } = new MessageChannel();
    const node = this.context.audioWorklet ? await this.#worklet(port2) : this.#script(port2);
    node.connect(this.gain).connect(this.analyser).connect(this.context.destination);
    this.worker.postMessage({ url: socketUrl("sound"), port: port1 }, [port1]);
  }

  /** @param {MessagePort} port where the sound comes from */
  async #worklet(port) {
    const { context } = this;
    await context.audioWorklet.addModule(new URL("./listening_processor.js", import.meta.url));
    const node = new AudioWorkletNode(context, "listening", {
      numberOfInputs: 0,
      outputChannelCount: [CHANNELS],
      processorOptions: { rate: this.rate },
    });
    node.port.postMessage({ port }, [port]);
    node.port.onmessage = ({ data }) => (this.told = data);
    this.end = () => node.port.postMessage({ close: true });
    return node;
  }

  /**
   * The way of pages that were loaded by plain http from another machine.
   * @param {MessagePort} port
   */
  #script(port) {
    const sound = new JitterBuffer(this.context.sampleRate, this.rate);
    const node = this.context.createScriptProcessor(SCRIPT_FRAMES, 0, CHANNELS);
    node.onaudioprocess = ({ outputBuffer }) => {
      sound.fillIn(outputBuffer.getChannelData(0), outputBuffer.getChannelData(1));
      this.told = { fill: sound.fill, gaps: sound.gaps };
    };
    port.onmessage = ({ data }) => sound.write(data.frame, data.samples);
    this.end = () => {
      node.onaudioprocess = null;
    };
    return node;
  }

  get status() {
    const { baseLatency = 0, outputLatency = 0, state } = this.context;
    return {
      latencyMs: 1e3 * (baseLatency + outputLatency + this.told.fill / this.rate),
      dropouts: this.told.gaps,
      running: state === "running",
    };
  }

  resume() {
    return this.context.resume();
  }

  close() {
    this.worker.terminate();
    const end = this.context.currentTime + FADE_S;
    this.gain.gain.linearRampToValueAtTime(0, end);
    setTimeout(() => {
      this.end?.();
      this.context.close();
    }, 2e3 * FADE_S);
  }
}
