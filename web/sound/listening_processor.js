/** Plays the server's sound on the browser's audio thread. */

import { JitterBuffer } from "./jitter_buffer.js";

const REPORT_S = 0.5;

/* global AudioWorkletProcessor, registerProcessor, sampleRate */

class Listening extends AudioWorkletProcessor {
  /** @param {{processorOptions: {rate: number}}} options */
  constructor({ processorOptions: { rate } }) {
    super();
    this.sound = new JitterBuffer(sampleRate, rate);
    this.isOpen = true;
    this.unreported = 0;
    this.port.onmessage = ({ data }) => {
      if (data.close) this.isOpen = false;
      else if (data.port) data.port.onmessage = this.port.onmessage;
      else this.sound.write(data.frame, data.samples);
    };
  }

  /** @param {Float32Array[][]} _inputs @param {Float32Array[][]} outputs */
  process(_inputs, outputs) {
    const [left, right] = outputs[0];
    this.sound.fillIn(left, right);
    this.unreported += left.length;
    if (this.unreported > REPORT_S * sampleRate) {
      this.unreported = 0;
      this.port.postMessage({ fill: this.sound.fill, gaps: this.sound.gaps });
    }
    return this.isOpen;
  }
}

registerProcessor("listening", Listening);
