/** The tabs beside the instrument, of which one panel is shown. */

/** @typedef {import('../main.js').Page} Page */

import { find, makeButton, words } from "../elements.js";
import { onLanguage, translate } from "../i18n.js";
import { remember, settings } from "../settings.js";

const PANELS = ["see", "sound", "tunes", "keep", "connect", "all"];

/**
 * @param {Page} page
 * @returns {() => void} shows the instrument, where a panel lies over it
 */
export function showTabs({ gallery }) {
  const list = find("tabs", HTMLElement);
  const more = find("more", HTMLElement);
  const shown = find("shown", HTMLElement);
  const update = () => (shown.textContent = settings.panel && translate(`tab.${settings.panel}`));
  const tabs = PANELS.map((name) => {
    const tab = makeButton(
      words(`tab.${name}`),
      () => choose(settings.panel === name ? "" : name),
      { role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}` },
    );
    find(`panel-${name}`, HTMLElement).setAttribute("aria-labelledby", tab.id);
    return tab;
  });
  list.append(...tabs);

  /** @param {string} chosen '': none */
  function choose(chosen) {
    PANELS.forEach((name, i) => {
      const isChosen = name === chosen;
      tabs[i].setAttribute("aria-selected", String(isChosen));
      // The arrow keys go to the others.
      tabs[i].tabIndex = isChosen || (chosen === "" && i === 0) ? 0 : -1;
      find(`panel-${name}`, HTMLElement).hidden = !isChosen;
    });
    const tab = tabs[Math.max(PANELS.indexOf(chosen), 0)];
    more.hidden = chosen === "";
    more.scrollTop = 0;
    list.scrollLeft = Math.min(list.scrollLeft, tab.offsetLeft); // on a narrow screen they scroll
    list.scrollLeft = Math.max(
      list.scrollLeft,
      tab.offsetLeft + tab.offsetWidth - list.clientWidth,
    );
    remember({ panel: chosen });
    update();
    gallery.renew();
  }

  list.addEventListener("keydown", (event) => {
    const at = tabs.findIndex((tab) => tab === document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: PANELS.length - 1 }[
      event.key
    ];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    const next = (to + PANELS.length) % PANELS.length;
    tabs[next].focus();
    choose(PANELS[next]);
  });
  find("close", HTMLButtonElement).addEventListener("click", () => {
    const tab = tabs[PANELS.indexOf(settings.panel)];
    choose("");
    tab?.focus();
  });
  onLanguage(update);
  choose(PANELS.includes(settings.panel) ? settings.panel : "");
  return () => getComputedStyle(more).position === "fixed" && choose("");
}
