/** The sounds: presets, the room, tunings, and what a MIDI keyboard's controllers do. */

/** @typedef {import('../main.js').Page} Page */

import { find, make } from "../elements.js";
import facts from "../facts.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { MAPPINGS } from "../playing/learned.js";
import { makeCards } from "./cards.js";
import { sourceName } from "./learn.js";
import { ROOMS, showRoom } from "./room.js";
import { nameFor } from "./slider.js";

/** @param {Page} page */
export function showSounds({ instrument, tuned, yehu, taught }) {
  const { player } = instrument;
  const panel = find("panel-sound", HTMLElement);
  panel.append(
    presets(player),
    showRoom(player, panel),
    chooser("tuning", Object.keys(facts.tunings), "equal", aboutTuning, (name) => {
      player.applyTuning(name);
      tuned.choose(name);
      yehu.isStale = true;
    }),
    chooser("mapping", Object.keys(MAPPINGS), taught.name, aboutMapping, (name) =>
      taught.choose(name),
    ),
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

/** @param {string} name */
function aboutTuning(name) {
  return translateOr(`tuning.${name}.about`, "");
}

/**
 * What each control of a mapping moves.
 * @param {string} name
 */
function aboutMapping(name) {
  /** @type {Map<string, string[]>} */
  const moved = new Map();
  for (const { source, target } of MAPPINGS[name].binds) {
    moved.set(source, [...(moved.get(source) ?? []), nameFor(target)]);
  }
  const told = [...moved].map(([source, names]) => `${sourceName(source)}: ${names.join(", ")}`);
  return told.join(" · ");
}

/**
 * A choice from a list of names.
 * @param {'tuning' | 'mapping'} what
 * @param {string[]} names
 * @param {string} first
 * @param {(name: string) => string} tellAbout
 * @param {(name: string) => void} apply
 */
function chooser(what, names, first, tellAbout, apply) {
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
    about.textContent = tellAbout(select.value);
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
