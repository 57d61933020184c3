/**
 * The two ways of sounding: an audio worklet, on a thread of its own; and where a page has none, being
 * loaded over plain http from another machine, a script processor on the page's thread.
 */

import { Engine } from "./engine.js";
import { CHANNELS } from "./kernel.js";

/** @typedef {import('./engine.js').Take} Take */
/** @typedef {import('./engine.js').Told} Told */

/**
 * @typedef {object} Backend
 * @property {'worklet' | 'script'} name
 * @property {AudioNode} node that sounds
 * @property {(message: Take, buffers?: Transferable[]) => void} take
 * @property {() => void} close
 */

const SCRIPT_FRAMES = 512;

/**
 * @param {AudioContext} context
 * @param {ArrayBuffer} bytes of the WebAssembly module
 * @param {number} lookLength
 * @param {(told: Told) => void} hear what it tells
 * @returns {Promise<Backend>}
 */
export async function openBackend(context, bytes, lookLength, hear) {
  return context.audioWorklet
    ? openWorklet(context, bytes, lookLength, hear)
    : openScript(context, bytes, lookLength, hear);
}

/** @type {typeof openBackend} */
async function openWorklet(context, bytes, lookLength, hear) {
  await context.audioWorklet.addModule(new URL("./processor.js", import.meta.url));
  const node = new AudioWorkletNode(context, "yehu", {
    numberOfInputs: 1, // a voice
    outputChannelCount: [CHANNELS],
    processorOptions: { bytes, lookLength },
  });
  node.port.onmessage = ({ data }) => hear(data);
  return {
    name: "worklet",
    node,
    take: (message, buffers = []) => node.port.postMessage(message, buffers),
    close: () => node.port.postMessage({ close: true }),
  };
}

/** @type {typeof openBackend} */
async function openScript(context, bytes, lookLength, hear) {
  const engine = new Engine(bytes, context.sampleRate, SCRIPT_FRAMES, lookLength, hear);
  const node = context.createScriptProcessor(SCRIPT_FRAMES, 0, CHANNELS);
  node.onaudioprocess = ({ outputBuffer }) =>
    engine.fill(outputBuffer.getChannelData(0), outputBuffer.getChannelData(1));
  return {
    name: "script",
    node,
    take: (message) => engine.take(message),
    close: () => {
      node.onaudioprocess = null;
    },
  };
}
