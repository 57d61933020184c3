/** The bytes of MIDI messages: which are whole, and what kind they are. */

export const NOTE_OFF = 0x80;
export const NOTE_ON = 0x90;
export const POLY_TOUCH = 0xa0;
export const CONTROL_CHANGE = 0xb0;
export const PROGRAM_CHANGE = 0xc0;
export const AFTERTOUCH = 0xd0;
export const PITCH_WHEEL = 0xe0;
const SYSTEM = 0xf0;
export const SYSTEM_RESET = 0xff;

/**
 * The kind of a message: the status of a channel message without its channel, or SYSTEM_RESET;
 * null for any other message, and for bytes that are none.
 * @param {ArrayLike<number>} bytes
 * @returns {number | null}
 */
export function kindOf(bytes) {
  const status = bytes[0] ?? 0;
  if (status >= SYSTEM) return status === SYSTEM_RESET && bytes.length === 1 ? status : null;
  const kind = status & 0xf0;
  const length = kind === PROGRAM_CHANGE || kind === AFTERTOUCH ? 2 : 3;
  if (kind < NOTE_OFF || bytes.length !== length) return null;
  return bytes[1] < 0x80 && (length === 2 || bytes[2] < 0x80) ? kind : null;
}
