/** How the instrument is played, beside it: assist, landing, articulation, loudness and vibrato. */

/** @typedef {import('../main.js').Page} Page */

import { find, make, makeSelect, makeSwitch, whileShown, words } from "../elements.js";
import facts from "../facts.js";
import { language } from "../i18n.js";
import { remember, settings } from "../settings.js";
import { makeSliders, nameFor } from "./slider.js";

export const ARTICULATION = "/playing/articulation";
const SLIDERS = { "/playing/volume": "ways.volume", "/playing/vibrato": "ways.vibrato" };

/** @param {Page} page */
export function showPlayingOptions({ instrument: { player }, hands, fingerboard }) {
  const assist = makeSwitch(
    words("ways.assist"),
    settings.isAssisted,
    (isAssisted) => {
      hands.rest();
      hands.isAssisted = isAssisted;
      remember({ isAssisted });
    },
    words("ways.assist.about"),
  );
  const landing = makeSwitch(
    words("ways.landing"),
    settings.isLandingInTune,
    (isLandingInTune) => {
      fingerboard.isLandingInTune = isLandingInTune;
      remember({ isLandingInTune });
    },
    words("ways.landing.about"),
  );
  find("ways", HTMLElement).append(
    make("div", { class: "switches" }, [assist, landing]),
    articulations(player),
    makeSliders(player, Object.keys(SLIDERS), Object.values(SLIDERS).map(words)),
  );
  shiftBy(fingerboard);
}

/**
 * What both hands do in the notes that begin; follows whoever else chooses: keys, controllers, presets.
 * @param {import('../interfaces.js').Player} player
 */
function articulations(player) {
  const options = facts.articulations.map(({ name, chinese }, number) => {
    const english = name.replaceAll("-", " ");
    return make("option", { value: String(number) }, [
      () => (language() === "zh" ? chinese : `${english} ${chinese}`),
    ]);
  });
  const name = () => nameFor(ARTICULATION);
  const select = makeSelect(name, options, (value) => {
    player.write(ARTICULATION, Number(value));
    remember({ articulation: Number(value) });
  });
  const follow = () => {
    const number = Math.round(player.value(ARTICULATION));
    const chosen = String(number < options.length ? number : 0);
    if (select.value !== chosen) select.value = chosen;
  };
  follow();
  whileShown(select, follow);
  return make("label", { class: "articulation" }, [make("span", {}, [name]), select]);
}

/** @param {import('../hands/fingerboard.js').Fingerboard} fingerboard */
function shiftBy(fingerboard) {
  const lower = find("lower", HTMLButtonElement);
  const higher = find("higher", HTMLButtonElement);
  const step = () => Math.min(fingerboard.scale.span - 1, 12); // no note is left out
  lower.addEventListener("click", () => fingerboard.shift(-step()));
  higher.addEventListener("click", () => fingerboard.shift(step()));
  const show = () => {
    lower.hidden = higher.hidden = !fingerboard.scale.isPart;
    lower.disabled = fingerboard.isLowest;
    higher.disabled = fingerboard.isHighest;
  };
  fingerboard.addEventListener("change", show);
  show();
}
