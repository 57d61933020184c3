/** The instrument in an audio worklet: computes samples on the browser's audio thread. */

import { Engine } from "./engine.js";

const MAX_FRAMES = 128;

/* global AudioWorkletProcessor, registerProcessor, sampleRate */

class Processor extends AudioWorkletProcessor {
  /** @param {{processorOptions: {bytes: ArrayBuffer, snapshotLength: number}}} options */
  constructor({ processorOptions: { bytes, snapshotLength } }) {
    super();
    this.engine = new Engine(bytes, sampleRate, MAX_FRAMES, snapshotLength, (report, buffers) =>
      this.port.postMessage(report, /** @type {Transferable[]} */ (buffers)),
    );
    this.isOpen = true;
    this.port.onmessage = ({ data }) => {
      if (data.close) this.isOpen = false;
      else this.engine.take(data);
    };
  }

  /**
   * @param {Float32Array[][]} inputs a voice, where there is one
   * @param {Float32Array[][]} outputs
   */
  process(inputs, outputs) {
    const [left, right] = outputs[0];
    const voice = inputs[0]?.[0];
    for (let done = 0; done < left.length; done += MAX_FRAMES) {
      const end = done + MAX_FRAMES;
      if (voice) this.engine.hear(voice.subarray(done, end));
      this.engine.fill(left.subarray(done, end), right.subarray(done, end));
    }
    return this.isOpen;
  }
}

registerProcessor("yehu", Processor);
