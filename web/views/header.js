/** The header: start, status, language, theme; and what prevents playing. */

/** @typedef {import('../main.js').Page} Page */

import { find } from "../elements.js";
import { remember, settings } from "../settings.js";
import { onLanguage, language, translate, setLanguage } from "../i18n.js";

const EVERY = 500; // ms
/** From here on load and latency are shown: else they are of no use to whoever plays. */
const HEAVY = 70; // %
const LATE = 100; // ms

/** @param {Page} page */
export function showHeader({ instrument, gallery }) {
  const start = find("start", HTMLButtonElement);
  const status = find("status", HTMLElement);
  const update = () => {
    start.textContent = translate(instrument.sound ? "header.silence" : "header.start");
    const { loadPercent = 0, latencyMs = 0 } = instrument.sound?.status ?? {};
    status.dataset.state = stateOf(instrument);
    const isWell = status.dataset.state === "on" && loadPercent < HEAVY && latencyMs < LATE;
    status.textContent = isWell ? "" : statusText(instrument);
  };
  start.addEventListener("click", () => {
    if (instrument.sound?.status.running) instrument.silence();
    else {
      instrument.start();
      start.dispatchEvent(new Event("begin")); // now: a click's other listeners are called once it may sound
    }
    update();
  });
  onLanguage(update);
  for (const event of ["start", "fail", "way"]) instrument.addEventListener(event, update);
  setInterval(() => document.hidden || update(), EVERY);
  find("language", HTMLButtonElement).addEventListener("click", () =>
    setLanguage(language() === "zh" ? "en" : "zh"),
  );
  find("theme", HTMLButtonElement).addEventListener("click", () => {
    const isDark = document.documentElement.dataset.theme === "dark";
    remember({ theme: isDark ? "light" : "dark" });
    document.documentElement.dataset.theme = settings.theme;
    gallery.renew();
  });
  onLanguage(() => gallery.renew());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => gallery.renew());
  showNotice(instrument);
}

/**
 * What prevents playing, in a line at the top.
 * @param {import('../instrument.js').Instrument} instrument
 */
function showNotice(instrument) {
  const notice = find("notice", HTMLElement);
  let key = "";
  const update = () => {
    notice.hidden = key === "";
    notice.classList.toggle("soft", key === "header.prepare"); // no fault
    notice.textContent = key && translate(key, { why: String(instrument.error) });
  };
  for (const event of ["prepare", "ready", "lack", "fail"]) {
    instrument.addEventListener(event, () => {
      key = event === "ready" ? "" : `header.${event}`;
      update();
      if (event !== "prepare") find("play", HTMLElement).removeAttribute("aria-busy");
    });
  }
  onLanguage(update);
}

/** @param {import('../instrument.js').Instrument} instrument */
function stateOf({ sound, opening }) {
  if (!sound) return opening ? "opening" : "off";
  if (sound.status.running) return "on";
  return sound.status.backend === "remote" ? "broken" : "waiting";
}

/** The state of the sound in a line. @param {import('../instrument.js').Instrument} instrument */
export function statusText(instrument) {
  const { loadPercent = 0, latencyMs = 0 } = instrument.sound?.status ?? {};
  const values = { load: loadPercent.toFixed(0), latency: latencyMs.toFixed(0) };
  return translate(`status.${stateOf(instrument)}`, values);
}
