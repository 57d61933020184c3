/** All parameters of the table, with search; each with its unit, its default and what it is. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../playing/table.js').Param} Param */

import { find, make, makeButton, whileShown, words } from "../elements.js";
import { GROUPS, TABLE } from "../playing/table.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { makeLearning } from "./learn.js";
import { aboutOf, makeRange, nameFor, unitFor, written } from "./slider.js";

/** @param {Page} page */
export function showParameters({ instrument, taught, midi }) {
  const panel = find("panel-all", HTMLElement);
  const label = words("all.search");
  const search = make("input", { type: "search", "aria-label": label, placeholder: label });
  const none = make("p", { class: "soft", role: "status" });
  const groups = GROUPS.map((name) => {
    const rows = TABLE.filter(({ group }) => group === name).map((param) =>
      row(
        instrument,
        param,
        param.playerControlled ? [] : makeLearning(param.address, taught, midi),
      ),
    );
    const count = make("span", { class: "soft" }, [String(rows.length)]);
    const details = make("details", {}, [
      make("summary", {}, [make("h2", {}, [() => translateOr(`group.${name}`, name)]), " ", count]),
      ...rows.map(({ element }) => element),
    ]);
    details.open = name === GROUPS[0];
    return { rows, details };
  });
  const seek = () => {
    const sought = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let found = 0;
    for (const { rows, details } of groups) {
      let inGroup = 0;
      for (const { element, text } of rows) {
        const all = text();
        element.hidden = !sought.every((word) => all.includes(word));
        if (!element.hidden) inGroup++;
      }
      details.hidden = inGroup === 0;
      if (sought.length) details.open = inGroup > 0;
      found += inGroup;
    }
    none.textContent = found ? "" : translate("all.none");
  };
  search.addEventListener("input", seek);
  onLanguage(seek);
  const resetAll = () => groups.forEach(({ rows }) => rows.forEach((one) => one.reset()));
  const reset = makeButton(words("all.reset"), resetAll, { class: "reset-all" });
  panel.append(
    make("div", { class: "row" }, [make("div", { class: "wide" }, [search]), reset]),
    none,
    ...groups.map(({ details }) => details),
  );
  whileShown(panel, () => {
    for (const { rows, details } of groups) {
      if (details.open) for (const one of rows) one.follow();
    }
  });
}

/**
 * @param {import('../instrument.js').Instrument} instrument
 * @param {Param} param
 * @param {HTMLElement[]} learning what makes a control move it
 */
function row({ player }, param, learning) {
  const { address, lo, hi, unit } = param;
  const label = () => nameFor(address);
  const limits = { min: lo, max: hi, step: "any" };
  const number = make("input", { type: "number", ...limits, "aria-label": label });
  const update = (/** @type {number} */ value) => {
    number.value = written(param, value);
  };
  const { range, show } = makeRange(player, address, (value) => {
    update(value);
    mark(value);
  });
  const title = () => translate("all.back", { value: written(param, param.default) });
  const back = makeButton("↺", () => reset(), {
    class: "quiet reset",
    title,
    "aria-label": () => `${label()}: ${title()}`,
  });
  const element = make("div", { class: "parameter" }, [
    make("h3", {}, [label]),
    make("div", { class: "value" }, [number, make("span", {}, [() => unitFor(unit)])]),
    back,
    range,
    ...learning,
    make("p", {}, [() => aboutOf(param), " ", make("code", {}, [address])]),
  ]);

  /** @param {number} value */
  function mark(value) {
    element.classList.toggle("changed", written(param, value) !== written(param, param.default));
  }
  const follow = () => {
    const value = player.value(address);
    show(value);
    if (document.activeElement !== number) update(value);
    mark(value);
  };
  const reset = () => {
    if (player.value(address) !== param.default) player.write(address, param.default);
    update(player.value(address));
    follow();
  };
  number.addEventListener("change", () => {
    const value = number.valueAsNumber;
    if (Number.isFinite(value)) player.write(address, Math.min(Math.max(value, lo), hi));
    update(player.value(address));
    follow();
  });
  onLanguage(follow);
  const text = () => `${label()} ${address} ${param.doc} ${aboutOf(param)}`.toLowerCase();
  return { element, text, follow, reset };
}
