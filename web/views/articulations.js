/** Chooses what both hands do in the notes that begin: spiccato, slides, trills and so on. */

/** @typedef {import('../interfaces.js').Player} Player */

import { make } from "../elements.js";
import facts from "../facts.js";
import { language } from "../i18n.js";
import { aboutOf, nameFor } from "./slider.js";
import { find } from "../playing/table.js";

const ADDRESS = "/playing/articulation";

/**
 * A chooser that follows whoever else chooses: keys, controllers, presets.
 * @param {Player} player
 */
export function makeArticulationChooser(player) {
  const select = make(
    "select",
    { "aria-label": () => nameFor(ADDRESS), title: () => aboutOf(find(ADDRESS)) },
    facts.articulations.map(([name, chinese], number) =>
      make("option", { value: String(number) }, [() => labelOf(name, chinese)]),
    ),
  );
  select.addEventListener("change", () => player.write(ADDRESS, Number(select.value)));
  const follow = () => {
    const number = Math.round(player.value(ADDRESS));
    const chosen = String(number < facts.articulations.length ? number : 0);
    if (select.value !== chosen) select.value = chosen;
  };
  follow();
  return { element: make("label", { class: "articulation" }, [select]), follow };
}

/**
 * @param {string} name
 * @param {string} chinese
 */
function labelOf(name, chinese) {
  const english = name.replaceAll("-", " ");
  return language() === "zh" ? `${chinese} (${english})` : `${english} ${chinese}`;
}
