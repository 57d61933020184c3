/** The example tunes: to listen to, or to play along with. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../tune.js').Tune} Tune */
/** @typedef {'listen' | 'along'} Way */

import { find, make } from "../elements.js";
import facts from "../facts.js";
import { TuneGuide, TunePlayer } from "../tune.js";
import { onLanguage, translate, translateOr } from "../i18n.js";

/** @type {Way[]} */
const WAYS = ["listen", "along"];

/** @param {Page} page */
export function showTunes(page) {
  const panel = find("panel-tunes", HTMLElement);
  const list = make("div", { class: "group" });
  page.instrument.addEventListener("silence", () => present?.stop());
  panel.append(make("p", { class: "soft" }, [() => translate("tunes.about")]), list);
  import("../examples.js").then(
    ({ default: examples }) => {
      // A JSON list has no type of its places, so that `events` is told here.
      const tunes = /** @type {Tune[]} */ (/** @type {unknown} */ (Object.values(examples)));
      // Tunes for the ordinary keyboard first: those are easiest to play.
      tunes.sort((one, other) => Number(isForOthers(one)) - Number(isForOthers(other)));
      list.append(...tunes.map((tune) => row(page, tune)));
    },
    () => list.append(make("p", {}, [() => translate("tunes.none")])),
  );
}

/** @param {Tune} tune */
function isForOthers({ mapping }) {
  return mapping !== facts.defaultMapping;
}

/** @type {TunePlayer | TuneGuide | null} what is on now */
let present = null;

/**
 * @param {Page} page
 * @param {Tune} tune
 */
function row(page, tune) {
  const name = () => translateOr(`tune.${tune.name}`, tune.name.replace(/_/g, " "));
  const buttons = WAYS.map((way) => {
    const label = () => `${translate(`tunes.${way}`)}: ${name()}`;
    const button = make("button", { type: "button", "aria-label": label });
    button.addEventListener("click", () => toggle(button, way));
    onLanguage(() => tell(button, way));
    return button;
  });
  const bar = make("progress", { max: 1, value: 0, "aria-label": name, hidden: true });

  /**
   * @param {HTMLButtonElement} button
   * @param {Way} way
   */
  async function toggle(button, way) {
    const isOn = button.getAttribute("aria-pressed") === "true";
    present?.stop();
    if (isOn) return;
    await page.instrument.start();
    if (!page.instrument.sound) return;
    const one =
      way === "listen"
        ? new TunePlayer(page.instrument, tune)
        : new TuneGuide(page.instrument, tune);
    present = one;
    button.setAttribute("aria-pressed", "true");
    tell(button, way);
    bar.hidden = false;
    one.addEventListener("move", () => {
      bar.value = one.progress;
      if (one instanceof TuneGuide) page.yehu.mark(one.next);
    });
    one.addEventListener("end", () => {
      button.setAttribute("aria-pressed", "false");
      tell(button, way);
      bar.hidden = true;
      page.yehu.mark(null);
      if (present === one) present = null;
    });
    one.start();
    if (way === "along") page.fingerboard.element.scrollIntoView({ block: "nearest" });
  }
  const length = `${Math.floor(tune.seconds / 60)}:${String(Math.round(tune.seconds % 60)).padStart(2, "0")}`;
  return make("article", { class: "tune" }, [
    make("h2", {}, [name, " ", make("span", { class: "soft" }, [length])]),
    make("p", { class: "soft" }, [() => translateOr(`tune.${tune.name}.about`, "")]),
    make("div", { class: "row" }, buttons),
    bar,
  ]);
}

/**
 * @param {HTMLButtonElement} button
 * @param {Way} way
 */
function tell(button, way) {
  const isOn = button.getAttribute("aria-pressed") === "true";
  button.textContent = translate(isOn ? "tunes.stop" : `tunes.${way}`);
}
