/** The room: where the instrument sounds, and where in it the player is. */

/** @typedef {import('../interfaces.js').Player} Player */

import { make } from "../elements.js";
import facts from "../facts.js";
import { translate } from "../i18n.js";
import { makeCards } from "./cards.js";
import { makeSlider } from "./slider.js";
import { whileShown } from "./tabs.js";

const SLIDERS = [
  "/room/level",
  "/room/size",
  "/room/decay",
  "/room/damping",
  "/room/distance",
  "/room/pan",
  "/body/width",
];
const EVERY = 250; // ms

/** Presets that set the room, and nothing else. */
export const ROOMS = Object.values(facts.presets.shipped).filter(({ values }) => {
  const addresses = Object.keys(values);
  return addresses.length > 0 && addresses.every((address) => SLIDERS.includes(address));
});

/**
 * @param {Player} player
 * @param {HTMLElement} panel that it is shown in
 */
export function showRoom(player, panel) {
  const sliders = SLIDERS.map((address) => makeSlider(player, address));
  whileShown(panel, () => sliders.forEach((slider) => slider.follow()), EVERY);
  return make("section", { class: "group", id: "room" }, [
    make("h2", {}, [() => translate("room.name")]),
    make("p", { class: "soft" }, [() => translate("room.about")]),
    ...(ROOMS.length ? [makeCards(player, ROOMS, () => translate("room.name"))] : []),
    make(
      "div",
      { class: "sliders" },
      sliders.map(({ element }) => element),
    ),
  ]);
}
