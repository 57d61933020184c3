/** Binds that were learned over a mapping: made, merged with it, kept, and written as a file. */

import facts from "../facts.js";
import { BEND, controller, isOfOneNote, isSource } from "./sources.js";
import { FREE, ParameterError, find } from "./table.js";

/**
 * A bind of a shipped mapping: one source that moves one target.
 * @typedef {object} ShippedBind
 * @property {string} source its name
 * @property {string} target address of the parameter
 * @property {readonly number[]} [channels] MIDI channels, 1 to 16, that it receives on; by default all
 * @property {{source: number} & Readonly<Record<string, number>>} row of the tables
 *
 * @typedef {object} LearnedBind One for all notes, along the curve of its target.
 * @property {string} source
 * @property {string} target
 * @property {readonly number[] | null} span the target's values at the two ends; null: its range
 * @property {boolean} isSoft the target moves only once the source has reached its value
 * @property {boolean} isAlone whether no bind of the mapping moves the target beside it
 * @property {boolean} isGlobal whether it moves every note, wherever the source is moved
 * @property {readonly LearnedBind[]} replaces those that come back when it is forgotten
 *
 * @typedef {ShippedBind | LearnedBind} Bind
 *
 * @typedef {object} Mapping As `facts.mappings` have it, merged with its bases.
 * @property {string} name
 * @property {string} about what it is for, in a line
 * @property {boolean} mpe whether every port starts as an MPE zone
 * @property {number | null} keySwitches the lowest key that chooses an articulation
 * @property {Readonly<Record<string, number>>} start values that parameters start with
 * @property {readonly number[]} x points of curves: positions of the source
 * @property {readonly number[]} y the same: fractions of the span
 * @property {readonly Bind[]} binds
 */

/** The shipped mappings, by name. @type {Readonly<Record<string, Mapping>>} */
export const MAPPINGS = /** @type {any} */ (facts.mappings);
const EXPONENTIAL = "exp";

/**
 * A bind of a source to a parameter, over its whole range, for all notes.
 * @param {string} target
 * @param {string} source
 * @param {boolean} isSoft
 * @param {boolean} [isAlone]
 * @returns {LearnedBind}
 */
export function bindOf(target, source, isSoft, isAlone = false) {
  const { address, playerControlled } = find(target);
  if (playerControlled) throw new ParameterError(`${address} is moved by the player`);
  const isByRange = source === BEND && address === "/playing/bend";
  return {
    source,
    target: address,
    span: null,
    isSoft: isSoft && !isOfOneNote(source) && !isByRange, // these cannot wait
    isAlone,
    isGlobal: !isOfOneNote(source),
    replaces: [],
  };
}

/**
 * The bind with other values of its target at the two ends; from high to low inverts.
 * @param {LearnedBind} bind
 * @param {number} from
 * @param {number} to
 * @returns {LearnedBind}
 */
export function spanned(bind, from, to) {
  const { lo, hi } = find(bind.target);
  if (!isWithin(bind, [from, to]))
    throw new ParameterError(`${from} to ${to} is not within ${lo} to ${hi}`);
  return { ...bind, span: from === lo && to === hi ? null : [from, to] };
}

/**
 * Whether a bind may have a span.
 * @param {{target: string}} bind
 * @param {readonly number[]} span
 */
function isWithin({ target }, span) {
  const { lo, hi, curve } = find(target);
  const isAbove = (/** @type {number} */ end) => curve !== EXPONENTIAL || end > 0;
  return span.every((end) => lo <= end && end <= hi && isAbove(end)); // refuses NaN
}

/**
 * Learned binds with one more, which replaces those of its controller and, if alone, of its target.
 * @param {readonly LearnedBind[]} learned
 * @param {LearnedBind} bind
 */
export function withBind(learned, bind) {
  const dropped = learned.filter((own) => excludes(bind, own));
  return [...learned.filter((own) => !dropped.includes(own)), replacing(bind, dropped)];
}

/**
 * Learned binds without some: what these replaced comes back, but for what was learned since.
 * @param {readonly LearnedBind[]} learned
 * @param {readonly LearnedBind[]} dropped
 */
export function withoutBinds(learned, dropped) {
  const binds = learned.filter((own) => !dropped.includes(own));
  for (const returned of dropped.flatMap((bind) => bind.replaces)) {
    const newer = binds.findIndex((own) => excludes(own, returned));
    if (newer < 0) binds.push(returned);
    else binds[newer] = replacing(binds[newer], [returned]);
  }
  return binds;
}

/**
 * Whether a bind replaces another.
 * @param {LearnedBind} bind
 * @param {LearnedBind} other
 */
function excludes(bind, other) {
  const isOfTarget = bind.isAlone && bind.target === other.target;
  return isOfTarget || overrideKey(bind) === overrideKey(other);
}

/**
 * A bind that keeps others, which come back with it: but not what its target has learned before.
 * @param {LearnedBind} bind
 * @param {readonly LearnedBind[]} dropped
 * @returns {LearnedBind}
 */
function replacing(bind, dropped) {
  const kept = new Map(bind.replaces.map((own) => [JSON.stringify(own), own]));
  for (const other of dropped) {
    const isPlain = other.target === bind.target && other.span === null;
    for (const own of [...(isPlain ? [] : [{ ...other, replaces: [] }]), ...other.replaces])
      kept.set(JSON.stringify(own), own);
  }
  return { ...bind, replaces: [...kept.values()] };
}

/**
 * A mapping overridden by learned binds, as one is by a file that has it as its base; one that is
 * alone replaces all that moved its target.
 * @param {Mapping} mapping
 * @param {readonly LearnedBind[]} learned
 * @returns {Mapping}
 */
export function merged(mapping, learned) {
  const overridden = new Set(learned.map(overrideKey));
  const moved = new Set(learned.filter((bind) => bind.isAlone).map((bind) => bind.target));
  const kept = mapping.binds.filter(
    (bind) => !overridden.has(overrideKey(bind)) && !moved.has(bind.target),
  );
  return { ...mapping, binds: [...kept, ...learned] };
}

/** Controller and channels: binds of equal keys replace each other. @param {Bind} bind */
function overrideKey(bind) {
  const channels = "row" in bind ? bind.channels : undefined;
  return `${controller(bind.source)}; ${channels ?? ""}`;
}

/**
 * The text of a mapping file (TOML) with a shipped mapping as its base.
 * @param {string} base its name
 * @param {Mapping} mapping
 * @param {readonly LearnedBind[]} learned
 */
export function fileOf(base, mapping, learned) {
  const about = `${mapping.about} With what you have taught it.`;
  const head = { name: mapping.name, about, base };
  const tables = learned.flatMap((bind) => [
    `\n[[bind]]\n${lines(entriesOf(bind))}`,
    ...bind.replaces.map((own) => `\n[[bind.replaces]]\n${lines(entriesOf(own))}`),
  ]);
  return lines(head) + tables.join("");
}

/** The entries of a bind, without those at their defaults. @param {LearnedBind} bind */
function entriesOf({ source, target, span, isSoft, isAlone, isGlobal }) {
  return {
    source,
    target,
    ...(span && { span }),
    ...(isSoft && { soft: true }),
    ...(isAlone && { alone: true }),
    ...(isGlobal && { global: true }),
    learned: true,
  };
}

/**
 * Lines of TOML: its texts, numbers and lists of numbers are written as in JSON.
 * @param {object} entries
 */
function lines(entries) {
  return Object.entries(entries)
    .map(([name, value]) => `${name} = ${JSON.stringify(value)}\n`)
    .join("");
}

/**
 * The binds of what a browser has kept, of which any part may be wrong or of an older version.
 * @param {unknown} kept
 * @returns {LearnedBind[]}
 */
export function readLearned(kept) {
  if (!Array.isArray(kept)) return [];
  /** @type {LearnedBind[]} */
  let learned = [];
  for (const one of kept) {
    const bind = readBind(one);
    if (bind) learned = [...learned.filter((own) => !excludes(bind, own)), bind];
  }
  return learned;
}

/**
 * @param {unknown} kept
 * @returns {LearnedBind | null} null: it is none
 */
function readBind(kept) {
  const { source, target, span, isSoft, isAlone, replaces } = Object(kept);
  if (!isSource(source) || !FREE.some(({ address }) => address === target)) return null;
  const plain = bindOf(target, source, isSoft === true, isAlone !== false); // once all were alone
  const isSpan = Array.isArray(span) && span.length === 2 && isWithin(plain, span);
  const bind = isSpan ? spanned(plain, span[0], span[1]) : plain;
  const others = Array.isArray(replaces)
    ? replaces.map(readBind).filter((own) => own !== null)
    : [];
  return { ...bind, replaces: others.map((own) => ({ ...own, replaces: [] })) };
}
