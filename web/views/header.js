/** The header: start, status, language, theme; and what stands in the way of playing. */

/** @typedef {import('../main.js').Page} Page */

import { find } from "../elements.js";
import { remember, settings } from "../settings.js";
import { onLanguage, language, translate, setLanguage } from "../i18n.js";

const EVERY = 500; // ms

/** @param {Page} page */
export function showHeader({ instrument, gallery }) {
  const start = find("start", HTMLButtonElement);
  const status = find("status", HTMLElement);
  const tell = () => {
    start.textContent = translate(instrument.sound ? "header.silence" : "header.start");
    status.textContent = statusText(instrument);
  };
  start.addEventListener("click", () => {
    if (instrument.sound?.status.running) instrument.silence();
    else instrument.start();
    tell();
  });
  onLanguage(tell);
  for (const event of ["start", "fail", "way"]) instrument.addEventListener(event, tell);
  setInterval(() => document.hidden || tell(), EVERY);
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
 * What stands in the way of playing, in a line at the top.
 * @param {import('../instrument.js').Instrument} instrument
 */
function showNotice(instrument) {
  const notice = find("notice", HTMLElement);
  let key = "";
  const tell = () => {
    notice.hidden = key === "";
    notice.textContent = key && translate(key, { why: String(instrument.error) });
  };
  for (const event of ["prepare", "ready", "lack", "fail"]) {
    instrument.addEventListener(event, () => {
      key = event === "ready" ? "" : `header.${event}`;
      tell();
      if (event !== "prepare") find("play", HTMLElement).removeAttribute("aria-busy");
    });
  }
  onLanguage(tell);
}

/** The state of the sound in a line. @param {import('../instrument.js').Instrument} instrument */
export function statusText({ sound, opening }) {
  if (!sound) return translate(opening ? "status.opening" : "status.off");
  const { running, backend, loadPercent, latencyMs } = sound.status;
  if (!running) return translate(backend === "remote" ? "status.broken" : "status.waiting");
  return translate("status.on", { load: loadPercent.toFixed(0), latency: latencyMs.toFixed(0) });
}
