/** How the instrument is played: assist, landing, direction, and the three most used sliders. */

/** @typedef {import('../main.js').Page} Page */

import { find, make, makeSwitch } from "../elements.js";
import { remember, settings } from "../settings.js";
import { onLanguage, translate } from "../i18n.js";
import { makeSlider } from "./slider.js";

const SLIDERS = [
  ["/playing/pressure", "ways.pressure"],
  ["/playing/bow_position", "ways.position"],
  ["/playing/vibrato", "ways.vibrato"],
];
const EVERY = 250; // ms

/** @param {Page} page */
export function showPlayingOptions({ instrument, hands, fingerboard }) {
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
  const switches = make("div", { class: "switches" }, [assist, landing, directions(fingerboard)]);
  const sliders = SLIDERS.map(([address, key]) =>
    makeSlider(instrument.player, address, () => translate(key)),
  );
  find("ways", HTMLElement).append(switches, ...sliders.map(({ element }) => element));
  setInterval(() => {
    if (!document.hidden) for (const slider of sliders) slider.follow();
  }, EVERY);
  shiftBy(fingerboard);
}

/** @param {import('../hands/fingerboard.js').Fingerboard} fingerboard */
function directions(fingerboard) {
  const hands = find("hands", HTMLElement);
  const choice = make("div", {
    class: "choice",
    role: "group",
    "aria-label": () => translate("ways.direction"),
  });
  const buttons = /** @type {const} */ (["across", "down"]).map((direction) => {
    const button = make("button", { type: "button" }, [() => translate(`ways.${direction}`)]);
    button.addEventListener("click", () => choose(direction));
    choice.append(button);
    return { direction, button };
  });

  /** @param {'across' | 'down'} chosen */
  function choose(chosen) {
    hands.classList.toggle("down", chosen === "down");
    fingerboard.turn(chosen);
    remember({ direction: chosen });
    for (const { direction, button } of buttons) {
      button.setAttribute("aria-pressed", String(direction === chosen));
    }
  }
  choose(settings.direction === "down" ? "down" : "across");
  return choice;
}

/** @param {import('../hands/fingerboard.js').Fingerboard} fingerboard */
function shiftBy(fingerboard) {
  const lower = find("lower", HTMLButtonElement);
  const higher = find("higher", HTMLButtonElement);
  lower.addEventListener("click", () => fingerboard.shift(-12));
  higher.addEventListener("click", () => fingerboard.shift(12));
  const show = () => {
    lower.hidden = higher.hidden = !fingerboard.scale.isPart;
    lower.disabled = fingerboard.isLowest;
    higher.disabled = fingerboard.isHighest;
  };
  fingerboard.addEventListener("change", show);
  show();
}
