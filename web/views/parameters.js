/** All parameters of the table, with search; each with its unit, its default and what it is. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../playing/table.js').Param} Param */

import { find, make, makeButton, whileShown, words } from "../elements.js";
import { FREE, GROUPS, TABLE } from "../playing/table.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { makeLearning } from "./learn.js";
import { aboutOf, makeRange, nameFor, unitFor, written } from "./slider.js";

/** @param {Page} page */
export function showParameters({ instrument, taught, midi }) {
  const { player } = instrument;
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
    const has = (/** @type {string} */ text) => sought.every((word) => text.includes(word));
    const ranked = groups.map(({ rows, details }) => {
      const found = rows.map(({ element, name, text }) => {
        const rank = has(name()) ? 0 : has(text()) ? 1 : NOT_FOUND;
        element.hidden = rank === NOT_FOUND;
        return { element, rank };
      });
      details.append(...inOrder(found));
      const rank = Math.min(...found.map((one) => one.rank));
      details.hidden = rank === NOT_FOUND;
      if (sought.length) details.open = !details.hidden;
      return { element: details, rank };
    });
    panel.append(...inOrder(ranked));
    none.textContent = ranked.every(({ rank }) => rank === NOT_FOUND) ? translate("all.none") : "";
  };
  // By Escape browsers empty the field with the latter event alone.
  for (const event of ["input", "search"]) search.addEventListener(event, seek);
  onLanguage(seek);
  /** What a reset has changed, and is given back. @type {[string, number][]} */
  let before = [];
  const moved = () =>
    FREE.filter(
      (param) => written(param, player.value(param.address)) !== written(param, param.default),
    );
  const resetAll = () => {
    if (before.length) {
      for (const [address, value] of before.splice(0)) player.write(address, value);
    } else {
      before = moved().map(({ address }) => [address, player.value(address)]);
      groups.forEach(({ rows }) => rows.forEach((one) => one.reset()));
    }
    follow();
  };
  const reset = makeButton("", resetAll, { class: "reset-all" });
  const follow = () => {
    if (moved().length) before = [];
    reset.textContent = translate(before.length ? "all.undo" : "all.reset");
    for (const { rows, details } of groups) {
      if (details.open) for (const one of rows) one.follow();
    }
  };
  onLanguage(follow);
  panel.append(
    make("div", { class: "row" }, [make("div", { class: "wide" }, [search]), reset]),
    none,
    ...groups.map(({ details }) => details),
  );
  seek();
  whileShown(panel, follow);
}

const NOT_FOUND = 2;

/** The best found first, the others as they were. @param {{element: HTMLElement, rank: number}[]} found */
const inOrder = (found) =>
  found.toSorted((one, other) => one.rank - other.rank).map(({ element }) => element);

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
  const name = () => `${label()} ${address}`.toLowerCase();
  const text = () => `${name()} ${param.doc} ${aboutOf(param)}`.toLowerCase();
  return { element, name, text, follow, reset };
}
