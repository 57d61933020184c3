/** Writes WAV files of 32-bit floats, as they were heard. */

const FLOAT = 3; // the format's number
const BITS = 32;
const HEAD = 44; // bytes

/**
 * @param {Float32Array[]} chunks of samples, of all channels in turn
 * @param {number} rate in Hz
 * @param {number} channels
 */
export function wav(chunks, rate, channels) {
  const frameBytes = (channels * BITS) / 8;
  const bytes = 4 * chunks.reduce((sum, chunk) => sum + chunk.length, 0);
  const view = new DataView(new ArrayBuffer(HEAD));
  /** @param {number} at @param {string} text */
  const write = (at, text) =>
    [...text].forEach((letter, i) => view.setUint8(at + i, letter.charCodeAt(0)));
  write(0, "RIFF");
  view.setUint32(4, HEAD - 8 + bytes, true);
  write(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, FLOAT, true);
  view.setUint16(22, channels, true);
  view.setUint32(24, rate, true);
  view.setUint32(28, rate * frameBytes, true);
  view.setUint16(32, frameBytes, true);
  view.setUint16(34, BITS, true);
  write(36, "data");
  view.setUint32(40, bytes, true);
  return new Blob([view, .../** @type {BlobPart[]} */ (chunks)], { type: "audio/wav" });
}
