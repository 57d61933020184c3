/** The sounds: presets, tunings, and what a MIDI keyboard's controllers do. */

/** @typedef {import('../main.js').Page} Page */

import { find, make } from "../elements.js";
import facts from "../facts.js";
import { inWords, say, sayOr } from "../words.js";

/** @param {Page} page */
export function showSounds({ instrument, tuned, board, taught }) {
  const { player } = instrument;
  find("panel-sound", HTMLElement).append(
    presets(player),
    chooser("tuning", Object.keys(facts.tunings), "equal", (name) => {
      player.applyTuning(name);
      tuned.choose(name);
      board.isStale = true;
    }),
    chooser("mapping", Object.keys(facts.mappings), taught.name, (name) => taught.choose(name)),
  );
}

/** @param {import('../interfaces.js').Player} player */
function presets(player) {
  const group = make("div", {
    class: "cards",
    role: "group",
    "aria-label": () => say("sound.presets"),
  });
  const cards = Object.values(facts.presets.shipped)
    .sort(byProgram)
    .map(({ name, about }) => {
      const card = make("button", { type: "button", "aria-pressed": "false" }, [
        make("span", {}, [() => sayOr(`preset.${name}`, name)]),
        make("small", {}, [() => sayOr(`preset.${name}.about`, about)]),
      ]);
      card.addEventListener("click", () => {
        player.applyPreset(name);
        for (const one of cards) one.setAttribute("aria-pressed", String(one === card));
      });
      return card;
    });
  group.append(...cards);
  return make("section", { class: "group" }, [make("h2", {}, [() => say("sound.presets")]), group]);
}

/**
 * @param {{program: number | null}} one
 * @param {{program: number | null}} other
 */
function byProgram(one, other) {
  return (one.program ?? Infinity) - (other.program ?? Infinity);
}

/**
 * A choice from a list of names.
 * @param {'tuning' | 'mapping'} what
 * @param {string[]} names
 * @param {string} first
 * @param {(name: string) => void} apply
 */
function chooser(what, names, first, apply) {
  const select = make(
    "select",
    { "aria-label": () => say(`sound.${what}`) },
    names.map((name) => make("option", { value: name }, [() => sayOr(`${what}.${name}`, name)])),
  );
  select.value = first;
  const about = make("p", { class: "soft" });
  const tell = () => {
    about.textContent = sayOr(`${what}.${select.value}.about`, "");
  };
  select.addEventListener("change", () => {
    apply(select.value);
    tell();
  });
  inWords(tell);
  return make("section", { class: "group" }, [
    make("h2", {}, [() => say(`sound.${what}`)]),
    select,
    about,
  ]);
}
