/** How the instrument is played: assist, landing, direction, loudness and vibrato. */

/** @typedef {import('../main.js').Page} Page */

import { find, make, makeSwitch } from "../elements.js";
import { remember, settings } from "../settings.js";
import { onLanguage, translate } from "../i18n.js";
import { makeArticulationChooser } from "./articulations.js";
import { makeSlider } from "./slider.js";

const SLIDERS = [
  ["/playing/volume", "ways.volume"],
  ["/playing/vibrato", "ways.vibrato"],
];
const EVERY = 250; // ms

/** @param {Page} page */
export function showPlayingOptions({ instrument, hands, fingerboard, surface }) {
  const assist = makeSwitch(
    () => translate("ways.assist"),
    settings.isAssisted,
    (isOn) => {
      hands.rest();
      hands.isAssisted = isOn;
      remember({ isAssisted: isOn });
    },
  );
  const landing = makeSwitch(
    () => translate("ways.landing"),
    settings.isLandingInTune,
    (isOn) => {
      fingerboard.isLandingInTune = isOn;
      remember({ isLandingInTune: isOn });
    },
  );
  onLanguage(() => {
    assist.title = translate("ways.assist.about");
    landing.title = translate("ways.landing.about");
  });
  const switches = make("div", { class: "switches" }, [assist, landing]);
  const sliders = SLIDERS.map(([address, key]) =>
    makeSlider(instrument.player, address, () => translate(key)),
  );
  const articulation = makeArticulationChooser(instrument.player);
  find("ways", HTMLElement).append(
    switches,
    articulation.element,
    ...sliders.map(({ element }) => element),
  );
  setInterval(() => {
    if (!document.hidden) for (const each of [...sliders, articulation]) each.follow();
  }, EVERY);
  find("bowing", HTMLElement).after(directions(surface));
  shiftBy(fingerboard);
}

/** @param {import('../hands/surface.js').Surface} surface */
function directions(surface) {
  const buttons = /** @type {const} */ (["across", "down"]).map((direction) => {
    const button = make("button", { type: "button" }, [() => translate(`ways.${direction}`)]);
    button.addEventListener("click", () => {
      // Chosen again, it lies as there is room.
      const wished = surface.wished === direction ? "" : direction;
      remember({ direction: wished });
      surface.turn(wished);
    });
    return { direction, button };
  });
  const show = () => {
    for (const { direction, button } of buttons) {
      button.setAttribute("aria-pressed", String(direction === surface.direction));
    }
  };
  surface.addEventListener("change", show);
  show();
  return make(
    "div",
    { class: "choice", role: "group", "aria-label": () => translate("ways.direction") },
    buttons.map(({ button }) => button),
  );
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
