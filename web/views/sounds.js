/** The sounds: presets, the room, tunings, and what a MIDI keyboard's controllers do. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../interfaces.js').Player} Player */

import {
  find,
  isServed,
  make,
  makeButton,
  makeSelect,
  note,
  section,
  whileShown,
  words,
} from "../elements.js";
import facts from "../facts.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { MAPPINGS } from "../playing/learned.js";
import { find as findParameter } from "../playing/table.js";
import { remember, settings } from "../settings.js";
import { sourceName } from "./learn.js";
import { ARTICULATION } from "./playing_options.js";
import { makeSliders, nameFor, written } from "./slider.js";

/** Presets that the page begins with; a server has a sound of its own. */
const AT_FIRST = isServed ? [] : ["vibrato", "chamber"];

/** @param {Player} player that begins as somebody has chosen here, or so */
export function beginSound(player) {
  const chosen = [settings.sound, settings.room];
  const isKnown = (/** @type {string} */ name) => Object.hasOwn(facts.presets.shipped, name);
  AT_FIRST.forEach((first, i) => player.applyPreset(isKnown(chosen[i]) ? chosen[i] : first));
  if (!isServed) player.write(ARTICULATION, settings.articulation);
}

/** Of the room, and of where in it the player is. */
const ROOM = [
  ...["level", "size", "decay", "damping", "distance", "pan"].map((name) => `/room/${name}`),
  "/body/width",
  "/body/gain",
];

/** @param {Page} page */
export function showSounds({ instrument: { player }, tuned, yehu, taught }) {
  const presets = Object.values(facts.presets.shipped).sort(
    (one, other) => (one.program ?? Infinity) - (other.program ?? Infinity),
  );
  const rooms = presets.filter(({ values }) => {
    const addresses = Object.keys(values);
    return addresses.length > 0 && addresses.every((address) => ROOM.includes(address));
  });
  const sounds = presets.filter((preset) => !rooms.includes(preset));
  // What a note moves itself, as by its velocity, makes no other sound.
  const isKept = (/** @type {string} */ address) =>
    !taught.movers(address).some((source) => facts.sources.OF_ONE_NOTE.includes(source));
  const room = section(
    "room.name",
    note(words("room.about")),
    ...(rooms.length ? [cards(player, rooms, "room", words("room.name"), isKept)] : []),
    makeSliders(player, ROOM),
  );
  room.id = "room";
  find("panel-sound", HTMLElement).append(
    section("sound.presets", cards(player, sounds, "sound", words("sound.presets"), isKept)),
    room,
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

/**
 * Presets to choose from. The one whose values the parameters have is pressed, whoever has set them; where some
 * are others, the one that most are of is called changed.
 * @param {Player} player
 * @param {{name: string, about: string, values: Readonly<Record<string, number>>}[]} presets
 * @param {"sound" | "room"} kind
 * @param {() => string} label of all of them, for screen readers
 * @param {(address: string) => boolean} isKept whether a parameter stays until somebody moves it
 */
function cards(player, presets, kind, label, isKept) {
  const all = presets.map(({ name, about, values }) => {
    const title = make("span");
    const card = makeButton("", () => {
      player.applyPreset(name);
      remember({ [kind]: name });
      follow();
    });
    card.append(title, make("small", {}, [() => translateOr(`preset.${name}.about`, about)]));
    const countChanged = () =>
      Object.entries(values).filter(([address, value]) => {
        const param = findParameter(address);
        const isOther = written(param, player.value(address)) !== written(param, value);
        return isOther && isKept(address);
      }).length;
    return { name, card, title, countChanged };
  });
  const follow = () => {
    const changed = all.map((one) => one.countChanged());
    const least = Math.min(...changed);
    all.forEach(({ name, card, title }, i) => {
      const called = translateOr(`preset.${name}`, name);
      const isChanged = least > 0 && i === changed.indexOf(least);
      title.textContent = isChanged ? translate("sound.changed", { name: called }) : called;
      card.setAttribute("aria-pressed", String(changed[i] === 0));
    });
  };
  const buttons = all.map(({ card }) => card);
  const element = make("div", { class: "cards", role: "group", "aria-label": label }, buttons);
  onLanguage(follow);
  whileShown(element, follow);
  return element;
}

/** @param {string} name */
const aboutTuning = (name) => translateOr(`tuning.${name}.about`, "");

/** What each control of a mapping moves, in lines. @param {string} name */
function aboutMapping(name) {
  /** @type {Map<string, string[]>} */
  const moved = new Map();
  for (const { source, target } of MAPPINGS[name].binds) {
    moved.set(source, [...(moved.get(source) ?? []), nameFor(target)]);
  }
  return [...moved]
    .map(([source, names]) => `${sourceName(source)}: ${names.join(", ")}`)
    .join("\n");
}

/**
 * A choice from a list of names.
 * @param {'tuning' | 'mapping'} what
 * @param {string[]} names
 * @param {string} first
 * @param {(name: string) => string} aboutOf
 * @param {(name: string) => void} apply
 */
function chooser(what, names, first, aboutOf, apply) {
  const options = names.map((name) =>
    make("option", { value: name }, [() => translateOr(`${what}.${name}`, name)]),
  );
  const about = make("p", { class: "soft lines" });
  const select = makeSelect(words(`sound.${what}`), options, (name) => {
    apply(name);
    update();
  });
  const update = () => {
    about.textContent = aboutOf(select.value);
  };
  select.value = first;
  onLanguage(update);
  return section(`sound.${what}`, select, about);
}
