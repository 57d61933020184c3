/** Writes a mapping and a tuning into tables of the interpreter, as the server has them. */

import facts from "../facts.js";
import { BEND, codeOf } from "./sources.js";
import { TABLE, find } from "./table.js";

/**
 * @typedef {import('./learned.js').Bind} Bind
 * @typedef {import('./learned.js').Mapping} Mapping
 *
 * @typedef {object} Tuning As `facts.tunings` have it.
 * @property {string} name
 * @property {readonly (number | null)[] | null} keys pitches of keys 0 to 127 (fractional MIDI
 *   notes; null for an unmapped key), at an A4 of 440 Hz; null where each key sounds its own number
 */

/** Where each field begins. @type {Record<string, number>} */
const AT = Object.fromEntries(
  Object.entries(facts.interpreter.tables).map(([name, [at]]) => [name, at]),
);
/** @type {Record<string, number>} */
const CURVES = facts.curves;
const ALL_BUT_PERCUSSION = -1;

/**
 * @param {Float64Array} tables
 * @param {Mapping} mapping
 * @param {Tuning} tuning
 */
export function writeTables(tables, { mpe, keySwitches, start, x, y, binds }, tuning) {
  tables.fill(0);
  /** @type {Map<number, number>} */
  const firsts = new Map();
  binds.forEach((bind, number) => {
    const row = rowOf(bind);
    if (!firsts.has(row.source)) firsts.set(row.source, number);
    const found = { first: firsts.get(row.source) ?? 0, target: find(bind.target).index };
    for (const [name, value] of Object.entries({ ...row, ...found })) {
      tables[AT[name] + number] = value;
    }
  });
  tables[AT.binds] = binds.length;
  tables.set(x, AT.x);
  tables.set(y, AT.y);
  tables[AT.mpe] = Number(mpe);
  tables[AT.first_switch] = keySwitches ?? NaN;
  tables.set(
    TABLE.map((param) => param.default),
    AT.usual,
  );
  Object.entries(start).forEach(([address, value], place) => {
    const { index } = find(address);
    tables[AT.usual + index] = tables[AT.start_value + place] = value;
    tables[AT.start_row + place] = index;
  });
  tables[AT.starts] = Object.keys(start).length;
  tables[AT.lowest] = facts.notes.LOWEST_NOTE;
  tables[AT.highest] = facts.notes.HIGHEST_NOTE;
  tables[AT.received] = ALL_BUT_PERCUSSION;
  writeTuning(tables, tuning);
}

/** @param {Float64Array} tables @param {Tuning} tuning */
export function writeTuning(tables, { keys }) {
  tables[AT.is_equal] = Number(keys === null);
  if (keys)
    tables.set(
      keys.map((pitch) => pitch ?? NaN),
      AT.pitch,
    );
}

/**
 * A bind's row of the tables, but for what depends on its place among others.
 * @param {Bind} bind
 * @returns {{source: number} & Record<string, number>}
 */
export function rowOf(bind) {
  if ("row" in bind) return bind.row;
  const { source, target, span, isSoft, isGlobal } = bind;
  const { lo, hi, curve } = find(target);
  return {
    source: codeOf(source),
    lo: span ? span[0] : lo,
    hi: span ? span[1] : hi,
    curve: CURVES[curve],
    soft: Number(isSoft),
    by_range: Number(source === BEND && target === "/playing/bend" && span === null),
    for_all: Number(isGlobal),
  };
}
