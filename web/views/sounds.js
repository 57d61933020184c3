/** The sounds: presets, the room, tunings, and what a MIDI keyboard's controllers do. */

/** @typedef {import('../main.js').Page} Page */

import { find, make } from "../elements.js";
import facts from "../facts.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { makeCards } from "./cards.js";
import { ROOMS, showRoom } from "./room.js";

/** @param {Page} page */
export function showSounds({ instrument, tuned, board, taught }) {
  const { player } = instrument;
  const panel = find("panel-sound", HTMLElement);
  panel.append(
    presets(player),
    showRoom(player, panel),
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
  const sounds = Object.values(facts.presets.shipped).filter((preset) => !ROOMS.includes(preset));
  return make("section", { class: "group" }, [
    make("h2", {}, [() => translate("sound.presets")]),
    makeCards(player, sounds, () => translate("sound.presets")),
  ]);
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
    { "aria-label": () => translate(`sound.${what}`) },
    names.map((name) =>
      make("option", { value: name }, [() => translateOr(`${what}.${name}`, name)]),
    ),
  );
  select.value = first;
  const about = make("p", { class: "soft" });
  const tell = () => {
    about.textContent = translateOr(`${what}.${select.value}.about`, "");
  };
  select.addEventListener("change", () => {
    apply(select.value);
    tell();
  });
  onLanguage(tell);
  return make("section", { class: "group" }, [
    make("h2", {}, [() => translate(`sound.${what}`)]),
    select,
    about,
  ]);
}
