/** Presets: sounds by name or MIDI program, and what lies between two of them. */

import { TABLE, accept, fromUnit, toUnit } from './table.js';
import { clamp } from './numbers.js';

/**
 * A preset as `facts.presets` have it.
 * @typedef {object} Preset
 * @property {string} name
 * @property {string} about
 * @property {number | null} program the MIDI program, 1 to 128, that selects it
 * @property {Readonly<Record<string, number>>} values of some parameters, by address
 */

/**
 * The first preset of a MIDI program, in the order given; null where there is none.
 * @param {Iterable<Preset>} presets
 * @param {number} program
 * @returns {Preset | null}
 */
export function ofProgram(presets, program) {
  for (const preset of presets) if (preset.program === program) return preset;
  return null;
}

/**
 * Interpolate between two presets, each value along its parameter's curve.
 *
 * `amount` is 0 for `one` and 1 for `other`, and is clamped. Choices, such as switches, change at
 * a half. A parameter that only one of them has is interpolated with its default.
 * @param {Preset} one
 * @param {Preset} other
 * @param {number} amount
 * @returns {Map<string, number>}
 */
export function morph(one, other, amount) {
  const share = clamp(amount, 0, 1);
  const values = new Map();
  for (const param of TABLE) {
    const { address } = param;
    const isIn = [one, other].some((preset) => Object.hasOwn(preset.values, address));
    if (param.owned || !isIn) continue;
    const from = one.values[address] ?? param.default;
    const to = other.values[address] ?? param.default;
    values.set(address, between(param, from, to, share));
  }
  return values;
}

/**
 * @param {import('./table.js').Param} param
 * @param {number} start
 * @param {number} end
 * @param {number} amount
 * @returns {number}
 */
function between(param, start, end, amount) {
  if (start === end || amount === 0) return start;
  if (amount === 1) return end;
  if (param.isChoice) return amount >= 0.5 ? end : start;
  const [low, high] = [toUnit(param, start), toUnit(param, end)];
  return accept(param, fromUnit(param, low + (high - low) * amount));
}
