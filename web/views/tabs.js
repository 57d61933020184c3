/** The tabs beside the instrument, of which one panel is shown. */

/** @typedef {import('../main.js').Page} Page */

import { find, make } from "../elements.js";
import { remember, settings } from "../settings.js";
import { translate } from "../i18n.js";

const PANELS = ["see", "sound", "tunes", "keep", "connect", "all"];

const FAR_DOWN = 0.8; // of the window's height

/** @param {Page} page */
export function showTabs({ gallery }) {
  const list = find("tabs", HTMLElement);
  const tabs = PANELS.map((name) => {
    const tab = make(
      "button",
      {
        type: "button",
        role: "tab",
        id: `tab-${name}`,
        "aria-controls": `panel-${name}`,
      },
      [() => translate(`tab.${name}`)],
    );
    tab.addEventListener("click", () => {
      choose(name);
      // On a phone what was chosen is below the instrument.
      const { top } = list.getBoundingClientRect();
      if (top > window.innerHeight * FAR_DOWN) list.scrollIntoView({ block: "start" });
    });
    find(`panel-${name}`, HTMLElement).setAttribute("aria-labelledby", tab.id);
    return tab;
  });
  list.append(...tabs);

  /** @param {string} chosen */
  function choose(chosen) {
    PANELS.forEach((name, i) => {
      const isChosen = name === chosen;
      tabs[i].setAttribute("aria-selected", String(isChosen));
      tabs[i].tabIndex = isChosen ? 0 : -1; // the arrow keys go to the others
      find(`panel-${name}`, HTMLElement).hidden = !isChosen;
    });
    const tab = tabs[PANELS.indexOf(chosen)];
    list.scrollLeft = Math.min(list.scrollLeft, tab.offsetLeft); // on a narrow screen they scroll
    list.scrollLeft = Math.max(
      list.scrollLeft,
      tab.offsetLeft + tab.offsetWidth - list.clientWidth,
    );
    remember({ panel: chosen });
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
  choose(PANELS.includes(settings.panel) ? settings.panel : PANELS[0]);
}

/**
 * Do something now and again, while a panel is shown.
 * @param {HTMLElement} panel
 * @param {() => void} action
 * @param {number} every ms
 */
export function whileShown(panel, action, every) {
  setInterval(() => {
    if (!panel.hidden && !document.hidden) action();
  }, every);
}
