/** The pictures beside the instrument, how the strings are seen, and one picture large for all to see. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../pictures/strings.js').View} View */

import { find, make, makeChoice, whileShown, words } from "../elements.js";
import { nameOf } from "../hands/scale.js";
import { SteadyPitch, regimeOf, soundingPitch } from "../sound/snapshot.js";
import { remember, settings } from "../settings.js";
import { onLanguage, translate } from "../i18n.js";
import { makeSliders } from "./slider.js";

const VIEWS = /** @type {const} */ (["slowed", "moving"]);
const DIRECTIONS = /** @type {const} */ (["across", "down"]);
/** How the player bows. */
const SLIDERS = ["/playing/pressure", "/playing/bow_position"];
const LINGERS = 2000; // ms after a note in which a finger on the diagram still places the bow
const EVERY = 150; // ms: a word that changes faster is not read

/** @param {Page} page */
export function showSeeing({ instrument, tuned, yehu, surface }) {
  const panel = find("panel-see", HTMLElement);
  const regime = find("regime", HTMLElement);
  const about = find("regime-about", HTMLElement);
  const tuner = find("tuner", HTMLCanvasElement);
  const schelleng = find("schelleng", HTMLCanvasElement);
  const steady = new SteadyPitch();
  instrument.addEventListener("state", () => {
    if (instrument.state) steady.take(soundingPitch(instrument.state), performance.now() / 1000);
  });
  let soundedAt = -Infinity;
  const update = () => {
    const name = regime.dataset.regime;
    regime.textContent = name ? translate(`regime.${name}`) : "";
    about.textContent = translate(`regime.${name ?? "silent"}.about`);
  };
  onLanguage(update);
  const follow = () => {
    const { state } = instrument;
    if (!state) return;
    if (state.bow.string >= 0) soundedAt = performance.now();
    // A narrow page is scrolled by a finger on the diagram, but not while a note sounds.
    schelleng.toggleAttribute("data-places", performance.now() - soundedAt < LINGERS);
    const name = regimeOf(state);
    if (regime.dataset.regime !== name) {
      regime.dataset.regime = name;
      update();
    }
    const { pitch } = steady;
    const note = tuned.nearest(pitch);
    const cents = Math.round((pitch - note) * 100);
    tuner.ariaLabel = Number.isNaN(pitch)
      ? translate("tuner.silent")
      : translate("tuner.text", { note: nameOf(note), cents });
  };
  whileShown(panel, follow, EVERY);
  panel.append(
    makeSliders(instrument.player, SLIDERS),
    row("strings.view", views(yehu)),
    row("strings.direction", directions(surface)),
  );
  for (const button of document.querySelectorAll(".enlarge")) {
    if (button instanceof HTMLButtonElement) enlargeBy(button);
  }
}

/** @param {string} key @param {HTMLElement} choice */
function row(key, choice) {
  return make("div", { class: "row" }, [make("span", { class: "soft" }, [words(key)]), choice]);
}

/** @param {import('../pictures/yehu.js').Yehu} yehu */
function views(yehu) {
  const { element, show } = makeChoice(words("strings.view"), VIEWS, "view", (view) => {
    const next = yehu.strings.view === view ? "still" : view; // what moves can be stopped
    remember({ view: next });
    set(next);
  });

  /** @param {View} view */
  function set(view) {
    yehu.strings.view = view;
    yehu.isStale = true;
    show(view);
  }
  // Nothing moves by itself before the eyes of whoever wants little motion.
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  const chosen = settings.view === "still" ? "still" : VIEWS.find((one) => one === settings.view);
  set(calm.matches ? "still" : (chosen ?? "slowed"));
  calm.addEventListener("change", () => calm.matches && set("still"));
  return element;
}

/** @param {import('../hands/surface.js').Surface} surface */
function directions(surface) {
  const { element, show } = makeChoice(words("strings.direction"), DIRECTIONS, "lies", (one) => {
    const direction = surface.requested === one ? "" : one; // chosen again, it lies as there is room
    remember({ direction });
    surface.turn(direction);
  });
  surface.addEventListener("change", () => show(surface.direction));
  show(surface.direction);
  return element;
}

/** @param {HTMLButtonElement} button */
function enlargeBy(button) {
  const figure = find(button.dataset.figure ?? "", HTMLElement);
  const isLarge = () => figure.classList.contains("large");

  /** @param {boolean} large */
  function set(large) {
    figure.classList.toggle("large", large);
    button.setAttribute("aria-pressed", String(large));
    if (large)
      figure.requestFullscreen?.().catch(() => {}); // it fills the window at least
    else if (document.fullscreenElement) document.exitFullscreen().catch(() => {});
  }
  set(false);
  button.addEventListener("click", () => set(!isLarge()));
  document.addEventListener("fullscreenchange", () => {
    if (!document.fullscreenElement && isLarge()) set(false);
  });
  window.addEventListener("keydown", ({ key }) => {
    if (key === "Escape" && isLarge()) set(false);
  });
}
