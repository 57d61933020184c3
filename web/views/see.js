/** The pictures beside the instrument: their words, and one of them large for all to see. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../pictures/strings.js').View} View */

import { find } from "../elements.js";
import { nameOf } from "../hands/scale.js";
import { regimeOf, soundingPitch } from "../pictures/regime.js";
import { remember, settings } from "../settings.js";
import { onLanguage, translate } from "../i18n.js";
import { makeSlider } from "./slider.js";
import { whileShown } from "./tabs.js";

/** @type {View[]} */
const VIEWS = ["slowed", "moving", "still"];
/** How the player bows. */
const SLIDERS = ["/playing/pressure", "/playing/bow_position"];
const LINGERS = 2000; // ms after a note in which a finger on the diagram still places the bow
const EVERY = 150; // ms: a word that changes faster is not read

/** @param {Page} page */
export function showSeeing({ instrument, yehu }) {
  const regime = find("regime", HTMLElement);
  const about = find("regime-about", HTMLElement);
  const tuner = find("tuner", HTMLCanvasElement);
  const schelleng = find("schelleng", HTMLCanvasElement);
  let soundedAt = -Infinity;
  onLanguage(() => {
    const name = regime.dataset.regime;
    regime.textContent = name ? translate(`regime.${name}`) : "";
    about.textContent = translate(`regime.${name ?? "silent"}.about`);
  });
  whileShown(
    find("panel-see", HTMLElement),
    () => {
      const { state } = instrument;
      if (!state) return;
      if (state.bow.string >= 0) soundedAt = performance.now();
      // A narrow page is scrolled by a finger on the diagram, but not while a note sounds.
      schelleng.toggleAttribute("data-places", performance.now() - soundedAt < LINGERS);
      const name = regimeOf(state);
      if (regime.dataset.regime !== name) {
        regime.dataset.regime = name;
        regime.textContent = translate(`regime.${name}`);
        about.textContent = translate(`regime.${name}.about`);
      }
      const pitch = soundingPitch(state);
      tuner.setAttribute(
        "aria-label",
        Number.isNaN(pitch)
          ? translate("tuner.silent")
          : translate("tuner.told", {
              note: nameOf(pitch),
              cents: Math.round((pitch - Math.round(pitch)) * 100),
            }),
      );
    },
    EVERY,
  );
  chooseView(yehu);
  const sliders = SLIDERS.map((address) => makeSlider(instrument.player, address));
  find("bowing", HTMLElement).append(...sliders.map(({ element }) => element));
  whileShown(find("panel-see", HTMLElement), () => sliders.forEach((one) => one.follow()), 250);
  for (const button of document.querySelectorAll(".enlarge")) {
    if (button instanceof HTMLButtonElement) enlargeBy(button);
  }
}

/** @param {import('../pictures/yehu.js').Yehu} yehu */
function chooseView(yehu) {
  const buttons = /** @type {const} */ (["slowed", "moving"]).map((view) => {
    const button = find(`view-${view}`, HTMLButtonElement);
    button.addEventListener("click", () => {
      const next = yehu.strings.view === view ? "still" : view; // what moves can be stopped
      remember({ view: next });
      choose(next);
    });
    return { view, button };
  });

  /** @param {View} chosen */
  function choose(chosen) {
    yehu.strings.view = chosen;
    yehu.isStale = true;
    for (const { view, button } of buttons) {
      button.setAttribute("aria-pressed", String(view === chosen));
    }
  }
  // Nothing moves by itself before the eyes of whoever wants little motion.
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const chosen = VIEWS.find((view) => view === settings.view) ?? "slowed";
  choose(calm.matches ? "still" : chosen);
  calm.addEventListener("change", () => {
    if (calm.matches) choose("still");
  });
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
