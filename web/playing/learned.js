/** Binds that were learned over a mapping: made, merged with it, kept, and written as a file. */

import facts from '../facts.js';
import { BEND, controller, isOfOneNote, isSource } from './sources.js';
import { ParameterError, TABLE, find } from './table.js';

/**
 * @typedef {import('./binds.js').BindFacts} BindFacts
 * @typedef {import('./mapping.js').MappingFacts} MappingFacts
 */

const { EXP } = facts.spec.CURVES;
/** The parameters that may be bound: the player moves the others itself. */
export const FREE = TABLE.filter(({ owned }) => !owned);

/**
 * A bind of a source to a parameter, over its whole range, for all notes.
 * @param {string} target
 * @param {string} source
 * @param {boolean} isSoft
 * @returns {BindFacts}
 */
export function bindOf(target, source, isSoft) {
  const { address, curve, owned } = find(target);
  if (owned) throw new ParameterError(`${address} is moved by the player`);
  const isByRange = source === BEND && address === '/playing/bend';
  return {
    source,
    target: address,
    span: null,
    curve,
    invert: false,
    smoothingMs: 0,
    channels: [],
    isSoft: isSoft && !isOfOneNote(source) && !isByRange, // these cannot wait
    inputRange: [0, 1],
    isExclusive: true,
    isGlobal: !isOfOneNote(source),
  };
}

/**
 * The bind with other values of its target at the two ends; from high to low inverts.
 * @param {BindFacts} bind
 * @param {number} from
 * @param {number} to
 * @returns {BindFacts}
 */
export function spanned(bind, from, to) {
  const { lo, hi } = find(bind.target);
  if (!isWithin(bind, [from, to])) throw new ParameterError(`${from} to ${to} is not within ${lo} to ${hi}`);
  return { ...bind, span: from === lo && to === hi ? null : [from, to] };
}

/**
 * Whether a bind may have a span.
 * @param {{target: string, curve: BindFacts['curve']}} bind
 * @param {readonly number[]} span
 */
function isWithin({ target, curve }, span) {
  const { lo, hi } = find(target);
  return span.every((end) => lo <= end && end <= hi && (curve !== EXP || end > 0)); // refuses NaN
}

/**
 * Learned binds with one more, which replaces those of its controller and of its target.
 * @param {readonly BindFacts[]} learned
 * @param {BindFacts} bind
 */
export function withBind(learned, bind) {
  const key = overrideKey(bind);
  const kept = learned.filter((own) => overrideKey(own) !== key && own.target !== bind.target);
  return [...kept, bind];
}

/**
 * A mapping overridden by learned binds, as one is by a file that has it as its base.
 * @param {MappingFacts} mapping
 * @param {readonly BindFacts[]} learned
 * @returns {MappingFacts}
 */
export function merged(mapping, learned) {
  const overridden = new Set(learned.map(overrideKey));
  const exclusive = new Set(learned.filter((bind) => bind.isExclusive).map((bind) => bind.target));
  const kept = mapping.binds.filter(
    (bind) => !overridden.has(overrideKey(bind)) && !exclusive.has(bind.target),
  );
  return { ...mapping, binds: [...kept, ...learned] };
}

/**
 * Controller and channels: binds of equal keys replace each other.
 * @param {BindFacts} bind
 */
function overrideKey({ source, channels }) {
  return `${controller(source)}; ${channels.join()}`;
}

/**
 * The text of a mapping file (TOML) with a shipped mapping as its base.
 * @param {string} base its name
 * @param {MappingFacts} mapping
 * @param {readonly BindFacts[]} learned
 */
export function fileOf(base, mapping, learned) {
  const about = `${mapping.about} With what you have taught it.`;
  const head = { name: mapping.name, about, base };
  const tables = learned.map((bind) => `\n[[bind]]\n${lines(entriesOf(bind))}`);
  return lines(head) + tables.join('');
}

/**
 * The entries of a bind, without those at their defaults.
 * @param {BindFacts} bind
 */
function entriesOf({ source, target, span, isSoft, isExclusive, isGlobal }) {
  return {
    source,
    target,
    ...(span && { span }),
    ...(isSoft && { soft: true }),
    ...(isExclusive && { alone: true }),
    ...(isGlobal && { global: true }),
  };
}

/**
 * Lines of TOML: its texts, numbers and lists of numbers are written as in JSON.
 * @param {object} entries
 */
function lines(entries) {
  return Object.entries(entries)
    .map(([name, value]) => `${name} = ${JSON.stringify(value)}\n`)
    .join('');
}

/**
 * The binds of what a browser has kept, of which any part may be wrong or of an older version.
 * @param {unknown} kept
 * @returns {BindFacts[]}
 */
export function readLearned(kept) {
  if (!Array.isArray(kept)) return [];
  /** @type {BindFacts[]} */
  let learned = [];
  for (const one of kept) {
    const { source, target, span, isSoft } = Object(one);
    if (!isSource(source) || !FREE.some(({ address }) => address === target)) continue;
    const bind = bindOf(target, source, isSoft === true);
    const isSpan = Array.isArray(span) && span.length === 2 && isWithin(bind, span);
    learned = withBind(learned, isSpan ? spanned(bind, span[0], span[1]) : bind);
  }
  return learned;
}
