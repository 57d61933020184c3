/** Plays the server's sound in the page; it comes by a WebSocket. */

import { JitterBuffer } from "./jitter_buffer.js";
import { Output } from "./output.js";
import { socketUrl } from "./server_connection.js";

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
    this.output = new Output(context);
    this.analyser = this.output.analyser;
    this.rate = rate;
    this.reported = { fill: 0, gaps: 0 };
    this.worker = new Worker(new URL("./listening_worker.js", import.meta.url), { type: "module" });
  }

  async #connect() {
    const { port1, port2 } = new MessageChannel();
    await this.output.connect({
      name: "listening",
      file: "listening_processor.js",
      options: { rate: this.rate },
      make: () => {
        const sound = new JitterBuffer(this.context.sampleRate, this.rate);
        port2.onmessage = ({ data }) => sound.write(data.frame, data.samples);
        return (left, right) => {
          sound.fillIn(left, right);
          this.reported = { fill: sound.fill, gaps: sound.gaps };
        };
      },
    });
    const { port } = this.output;
    if (port) {
      port.postMessage({ port: port2 }, [port2]);
      port.onmessage = ({ data }) => (this.reported = data);
    }
    this.worker.postMessage({ url: socketUrl("sound"), port: port1 }, [port1]);
  }

  get status() {
    return {
      latencyMs: this.output.latencyMs + (1e3 * this.reported.fill) / this.rate,
      dropouts: this.reported.gaps,
      running: this.context.state === "running",
    };
  }

  resume() {
    return this.context.resume();
  }

  close() {
    this.worker.terminate();
    this.output.close();
  }
}
