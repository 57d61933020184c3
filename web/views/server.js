/** Where the sound of a page that has a server is made, and where it is heard. */

/** @typedef {import('../instrument.js').Instrument} Instrument */
/** @typedef {'here' | 'there' | 'listen'} Way */

import facts from "../facts.js";
import { find, make } from "../elements.js";
import { TABLE } from "../playing/table.js";
import { remember, settings } from "../settings.js";
import { ServerConnection } from "../sound/server_connection.js";
import { Remote } from "../sound/remote.js";
import { Sharing } from "../sound/sharing.js";
import { onLanguage, translate } from "../i18n.js";
import { showPart } from "./part.js";

/** @type {Way[]} */
const WAYS = ["here", "there", "listen"];
const LOOKED_MS = 1000; // a server that is away is not waited for any longer

/**
 * The choice, and the state of the server.
 * @param {Instrument} instrument
 */
export function showServer(instrument) {
  const line = new ServerConnection();
  instrument.others = line;
  instrument.way = () => line.ready; // where to sound is chosen once the server tells what it has
  showPart(line);
  const about = make("p", { class: "soft" });
  const state = make("p", { class: "soft", role: "status" });
  const choice = make("div", {
    class: "choice",
    role: "group",
    "aria-label": () => translate("server.name"),
  });
  /** @type {Way | null} */
  let chosen = null;
  let rate = 0;
  /** @type {Sharing | null} */
  let sharing = null;
  const buttons = WAYS.map((way) => {
    const button = make("button", { type: "button", id: `way-${way}` }, [
      () => translate(`server.${way}`),
    ]);
    button.addEventListener("click", () => {
      remember({ way });
      choose(way);
      instrument.start(); // while the touch counts
    });
    choice.append(button);
    return { way, button };
  });

  /** @param {Way} way */
  function choose(way) {
    chosen = way;
    rate = line.status.rate;
    const before = sharing;
    sharing = null;
    instrument.change(way === "here" ? openAlike : () => Remote.open(line, way === "listen"));
    before?.close();
    if (way === "here") sharing = new Sharing(instrument, line);
    if (way === "there") instrument.start(); // a picture needs no touch
    tell();
  }

  /** The sound of this page, with the parameters that the server has. */
  async function openAlike() {
    const sound = await instrument.openHere();
    await Promise.race([line.looked, new Promise((resolve) => setTimeout(resolve, LOOKED_MS))]);
    for (const { address, row, owned } of TABLE) {
      const value = line.wasSet(address) ?? instrument.player.value(address);
      if (!owned) sound.post(null, facts.kinds.WRITE, row, value, 0);
    }
    return sound;
  }

  function tell() {
    const { device, pages, sounds, parts } = line.status;
    for (const { way, button } of buttons) {
      button.setAttribute("aria-pressed", String(way === chosen));
      button.disabled = way === "here" && sounds !== "ready";
    }
    document.documentElement.dataset.role = line.status.role; // hides what the owner alone may do
    about.textContent = chosen ? translate(`server.${chosen}.about`) : "";
    if (line.status.role !== "own") {
      about.textContent += ` ${translate(`server.role.${line.status.role}`)}`;
    }
    if (chosen && parts > 1) about.textContent += ` ${translate("server.parts")}`;
    const own = {
      preparing: translate("server.preparing"),
      ready: "",
      none: translate("server.impossible"),
    };
    const told = [
      device ? translate("server.device", { device }) : translate("server.silent"),
      translate("server.pages", { count: pages }),
      own[sounds],
    ];
    state.textContent = line.isOpen ? told.filter(Boolean).join(" ") : translate("server.gone");
  }

  line.addEventListener("status", () => {
    const { device, sounds } = line.status;
    if (chosen === null) {
      const first = WAYS.find((way) => way === settings.way) ?? (device ? "there" : "listen");
      choose(first === "here" && sounds !== "ready" ? "there" : first);
    } else if (chosen === "listen" && rate !== line.status.rate) {
      choose(chosen); // another server, at another rate
      instrument.start();
    }
    tell();
  });
  onLanguage(tell);
  line.addEventListener("break", () => {
    if (chosen !== "here") instrument.silence(); // the server has ended what this page held
    tell();
  });
  find("panel-connect", HTMLElement).prepend(
    make("section", { class: "group" }, [
      make("h2", {}, [() => translate("server.name")]),
      choice,
      about,
      state,
      askForPin(line),
    ]),
  );
}

/**
 * A question for the PIN, which shows where the server refuses the one it got.
 * @param {ServerConnection} line
 */
function askForPin(line) {
  const pin = make("input", { inputmode: "numeric", "aria-label": () => translate("server.pin") });
  const form = make("form", { hidden: true }, [
    make("p", {}, [() => translate("server.pin")]),
    pin,
    make("button", {}, [() => translate("server.pin.send")]),
  ]);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const url = new URL(location.href);
    url.searchParams.set("pin", pin.value.trim());
    location.assign(url);
  });
  line.addEventListener("refuse", () => {
    form.hidden = false;
    // Else nobody would see it; a click on the tab that is shown would close it.
    if (find("panel-connect", HTMLElement).hidden) find("tab-connect", HTMLElement).click();
    pin.focus();
  });
  return form;
}
