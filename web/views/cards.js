/** Presets as cards to choose from. */

/** @typedef {import('../interfaces.js').Player} Player */

import { isServed, make } from "../elements.js";
import { translateOr } from "../i18n.js";

/** Presets that the page begins with; a server has a sound of its own. */
export const AT_FIRST = isServed ? [] : ["vibrato", "courtyard"];

/**
 * @param {Player} player
 * @param {{name: string, about: string, program: number | null}[]} presets
 * @param {() => string} name of all of them, for screen readers
 */
export function makeCards(player, presets, name) {
  const cards = presets.sort(byProgram).map((preset) => {
    const card = make(
      "button",
      { type: "button", "aria-pressed": String(AT_FIRST.includes(preset.name)) },
      [
        make("span", {}, [() => translateOr(`preset.${preset.name}`, preset.name)]),
        make("small", {}, [() => translateOr(`preset.${preset.name}.about`, preset.about)]),
      ],
    );
    card.addEventListener("click", () => {
      player.applyPreset(preset.name);
      for (const one of cards) one.setAttribute("aria-pressed", String(one === card));
    });
    return card;
  });
  return make("div", { class: "cards", role: "group", "aria-label": name }, cards);
}

/**
 * @param {{program: number | null}} one
 * @param {{program: number | null}} other
 */
function byProgram(one, other) {
  return (one.program ?? Infinity) - (other.program ?? Infinity);
}
