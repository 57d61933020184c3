/** A slider for a parameter of the table, which follows whoever else moves it. */

/** @typedef {import('../interfaces.js').Player} Player */
/** @typedef {import('../interfaces.js').Parameter} Parameter */

import { make, whileShown } from "../elements.js";
import { find, fromUnit, toUnit } from "../playing/table.js";
import { onLanguage, translateOr } from "../i18n.js";

const STEPS = 1000;

/** The display name of a parameter. @param {string} address */
export function nameFor(address) {
  return translateOr(`parameter${address}`, find(address).label);
}

/** The description of a parameter. @param {Parameter} param */
export function aboutOf({ address, doc }) {
  return translateOr(`about${address}`, doc);
}

/** A unit as it is written after a number; nothing for a bare one. @param {string} unit */
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
 * A value with its unit; shares in percent.
 * @param {Parameter} param
 * @param {number} value
 */
function valueText(param, value) {
  const isShare = param.unit === "1" && param.lo === 0 && param.hi === 1;
  if (isShare) return `${Math.round(100 * value)} %`;
  return `${written(param, value)} ${unitFor(param.unit)}`.trim();
}

/**
 * A range input along the parameter's curve.
 * @param {Player} player
 * @param {string} address
 * @param {(value: number) => void} changed by hand
 */
export function makeRange(player, address, changed) {
  const param = find(address);
  const max = param.isChoice && param.hi - param.lo < STEPS ? param.hi - param.lo : STEPS;
  const label = () => nameFor(address);
  const range = make("input", { type: "range", min: 0, max, step: 1, "aria-label": label });
  let isHeld = false;
  const update = (/** @type {number} */ value) =>
    range.setAttribute("aria-valuetext", valueText(param, value));
  range.addEventListener("pointerdown", () => (isHeld = true));
  for (const end of ["pointerup", "pointercancel", "blur"]) {
    range.addEventListener(end, () => (isHeld = false));
  }
  range.addEventListener("input", () => {
    const value = fromUnit(param, Number(range.value) / max);
    player.write(address, value);
    update(value);
    changed(value);
  });

  /** @param {number} value */
  function show(value) {
    if (isHeld) return;
    range.value = String(Math.round(toUnit(param, value) * max));
    update(value);
  }
  show(player.value(address));
  return { range, show };
}

/**
 * Sliders with their names and values above them, which follow whoever else moves them.
 * @param {Player} player
 * @param {string[]} addresses
 * @param {(() => string)[]} [names] shorter ones
 */
export function makeSliders(player, addresses, names = []) {
  const sliders = addresses.map((address, i) => {
    const param = find(address);
    const output = make("output");
    const update = (/** @type {number} */ value) => {
      output.textContent = valueText(param, value);
    };
    const { range, show } = makeRange(player, address, update);
    const name = names[i] ?? (() => nameFor(address));
    const element = make("label", { class: "slider", title: () => aboutOf(param) }, [
      make("span", {}, [name]),
      output,
      range,
    ]);
    const follow = () => {
      const value = player.value(address);
      show(value);
      update(value);
    };
    onLanguage(follow);
    return { element, follow };
  });
  const element = make("div", { class: "sliders" }, sliders.map((one) => one.element)); // prettier-ignore
  whileShown(element, () => sliders.forEach((one) => one.follow()));
  return element;
}
