/** The header: start, status, language, theme. */

/** @typedef {import('../main.js').Page} Page */

import { find } from "../elements.js";
import { remember, settings } from "../settings.js";
import { onLanguage, language, translate, setLanguage } from "../i18n.js";

const EVERY = 500; // ms

/** @param {Page} page */
export function showHeader({ instrument, gallery }) {
  const start = find("start", HTMLButtonElement);
  const status = find("status", HTMLElement);
  start.addEventListener("click", () => {
    if (instrument.sound?.status.running) instrument.silence();
    else instrument.start();
    tell();
  });
  showNotice(instrument);
  const tell = () => {
    start.textContent = translate(instrument.sound ? "header.silence" : "header.start");
    status.textContent =
      instrument.opening && !instrument.sound
        ? translate("status.opening")
        : statusText(instrument.sound?.status ?? null);
  };
  onLanguage(tell);
  for (const event of ["start", "fail", "way"]) instrument.addEventListener(event, tell);
  setInterval(() => {
    if (!document.hidden) tell();
  }, EVERY);
  find("language", HTMLButtonElement).addEventListener("click", () => {
    setLanguage(language() === "zh" ? "en" : "zh");
  });
  find("theme", HTMLButtonElement).addEventListener("click", () => {
    const isDark = document.documentElement.dataset.theme === "dark";
    remember({ theme: isDark ? "light" : "dark" });
    document.documentElement.dataset.theme = settings.theme;
    gallery.renew();
  });
  onLanguage(() => gallery.renew());
  darkSystem.addEventListener("change", () => gallery.renew());
}

/**
 * What stands in the way of playing, in a line at the top.
 * @param {import('../instrument.js').Instrument} instrument
 */
function showNotice(instrument) {
  const notice = find("notice", HTMLElement);
  let [key, why] = ["", ""];
  const tell = () => {
    notice.hidden = key === "";
    notice.textContent = key && translate(key, { why });
  };
  for (const event of ["prepare", "ready", "lack", "fail"]) {
    instrument.addEventListener(event, () => {
      key = event === "ready" ? "" : `header.${event}`;
      why = String(instrument.error);
      tell();
      if (event !== "prepare") find("play", HTMLElement).removeAttribute("aria-busy");
    });
  }
  onLanguage(tell);
}

const darkSystem = matchMedia("(prefers-color-scheme: dark)");

/**
 * The state of the sound in a line.
 * @param {import('../interfaces.js').Status | null} status
 */
export function statusText(status) {
  if (!status) return translate("status.off");
  if (!status.running) {
    return translate(status.backend === "remote" ? "status.broken" : "status.waiting");
  }
  const load = status.loadPercent.toFixed(0);
  const latency = status.latencyMs.toFixed(0);
  return translate("status.on", { load, latency });
}
