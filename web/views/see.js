/** The pictures beside the instrument: their words, and one of them large for all to see. */

/** @typedef {import('../main.js').Page} Page */

import { find } from "../elements.js";
import { nameOf } from "../hands/scale.js";
import { regimeOf, soundingPitch } from "../pictures/regime.js";
import { remember, settings } from "../settings.js";
import { say } from "../words.js";
import { whileShown } from "./tabs.js";

const EVERY = 150; // ms: a word that changes faster is not read

/** @param {Page} page */
export function showSeeing({ instrument, strings }) {
  const regime = find("regime", HTMLElement);
  const about = find("regime-about", HTMLElement);
  const tuner = find("tuner", HTMLCanvasElement);
  about.textContent = say("regime.silent.about");
  whileShown(
    find("panel-see", HTMLElement),
    () => {
      const { state } = instrument;
      if (!state) return;
      const name = regimeOf(state);
      if (regime.dataset.regime !== name) {
        regime.dataset.regime = name;
        regime.textContent = say(`regime.${name}`);
        about.textContent = say(`regime.${name}.about`);
      }
      const pitch = soundingPitch(state);
      tuner.setAttribute(
        "aria-label",
        Number.isNaN(pitch)
          ? say("tuner.silent")
          : say("tuner.told", {
              note: nameOf(pitch),
              cents: Math.round((pitch - Math.round(pitch)) * 100),
            }),
      );
    },
    EVERY,
  );
  chooseView(strings);
  for (const button of document.querySelectorAll(".enlarge")) {
    if (button instanceof HTMLButtonElement) enlargeBy(button);
  }
}

/** @param {import('../pictures/strings.js').Strings} strings */
function chooseView(strings) {
  const buttons = /** @type {const} */ (["slowed", "moving"]).map((view) => {
    const button = find(`view-${view}`, HTMLButtonElement);
    button.addEventListener("click", () => choose(view));
    return { view, button };
  });

  /** @param {'slowed' | 'moving'} chosen */
  function choose(chosen) {
    strings.view = chosen;
    strings.isStale = true;
    remember({ view: chosen });
    for (const { view, button } of buttons) {
      button.setAttribute("aria-pressed", String(view === chosen));
    }
  }
  choose(settings.view === "moving" ? "moving" : "slowed");
}

/** @param {HTMLButtonElement} button */
function enlargeBy(button) {
  const figure = find(button.dataset.figure ?? "", HTMLElement);
  button.setAttribute("aria-pressed", "false");

  /** @param {boolean} isLarge */
  function set(isLarge) {
    figure.classList.toggle("large", isLarge);
    button.setAttribute("aria-pressed", String(isLarge));
    if (isLarge)
      figure.requestFullscreen?.().catch(() => {}); // it fills the window at least
    else if (document.fullscreenElement) document.exitFullscreen().catch(() => {});
  }
  button.addEventListener("click", () => set(!figure.classList.contains("large")));
  document.addEventListener("fullscreenchange", () => {
    if (!document.fullscreenElement && figure.classList.contains("large")) set(false);
  });
  window.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && figure.classList.contains("large")) set(false);
  });
}
