/** A slider for a parameter of the table, which follows whoever else moves it. */

/** @typedef {import('../interfaces.js').Player} Player */
/** @typedef {import('../interfaces.js').Parameter} Parameter */

import { make } from "../elements.js";
import { find, fromUnit, toUnit } from "../playing/table.js";
import { onLanguage, translateOr } from "../i18n.js";

const STEPS = 1000;

/**
 * The name of a parameter, for people.
 * @param {string} address
 */
export function nameFor(address) {
  return translateOr(`parameter${address}`, find(address).label);
}

/**
 * What a parameter is, in a sentence.
 * @param {Parameter} param
 */
export function aboutOf({ address, doc }) {
  return translateOr(`about${address}`, doc);
}

/**
 * A unit as it is written after a number; nothing for a bare one.
 * @param {string} unit
 */
export function unitFor(unit) {
  return unit === "1" ? "" : translateOr(`unit.${unit}`, unit);
}

/**
 * A value with as many digits as its range needs.
 * @param {Parameter} param
 * @param {number} value
 */
export function written(param, value) {
  if (param.isChoice) return String(Math.round(value));
  const digits = Math.max(0, Math.min(4, 2 - Math.floor(Math.log10(param.hi - param.lo))));
  return String(Number(value.toFixed(digits)));
}

/**
 * A range input along the parameter's curve.
 * @param {Player} player
 * @param {string} address
 * @param {(value: number) => void} changed by hand
 */
export function makeRange(player, address, changed) {
  const param = find(address);
  const steps = param.isChoice && param.hi - param.lo < STEPS ? param.hi - param.lo : STEPS;
  const range = make("input", {
    type: "range",
    min: 0,
    max: steps,
    step: 1,
    "aria-label": () => nameFor(address),
  });
  let isHeld = false;
  range.addEventListener("pointerdown", () => {
    isHeld = true;
  });
  for (const end of ["pointerup", "pointercancel", "blur"]) {
    range.addEventListener(end, () => {
      isHeld = false;
    });
  }
  range.addEventListener("input", () => {
    const value = fromUnit(param, Number(range.value) / steps);
    player.write(address, value);
    range.setAttribute("aria-valuetext", `${written(param, value)} ${unitFor(param.unit)}`);
    changed(value);
  });

  /** @param {number} value */
  function show(value) {
    if (isHeld) return;
    range.value = String(Math.round(toUnit(param, value) * steps));
    range.setAttribute("aria-valuetext", `${written(param, value)} ${unitFor(param.unit)}`);
  }
  show(player.value(address));
  return { range, show };
}

/**
 * A slider with its name and value above it.
 * @param {Player} player
 * @param {string} address
 * @param {() => string} [name] a shorter one
 */
export function makeSlider(player, address, name = () => nameFor(address)) {
  const param = find(address);
  const output = make("output");
  const tell = (/** @type {number} */ value) => {
    output.textContent = `${written(param, value)} ${unitFor(param.unit)}`.trim();
  };
  const { range, show } = makeRange(player, address, tell);
  const element = make("label", { class: "slider", title: () => aboutOf(param) }, [
    make("span", {}, [name]),
    output,
    range,
  ]);
  const follow = () => {
    const value = player.value(address);
    show(value);
    tell(value);
  };
  onLanguage(follow);
  return { element, follow };
}
