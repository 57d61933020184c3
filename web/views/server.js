/** Where the sound of a page that has a server is made, and where it is heard. */

/** @typedef {import('../instrument.js').Instrument} Instrument */
/** @typedef {'here' | 'there' | 'listen'} Way */

import facts from "../facts.js";
import { make } from "../elements.js";
import { TABLE } from "../playing/table.js";
import { remember, settings } from "../settings.js";
import { ServerConnection } from "../sound/server_connection.js";
import { Remote } from "../sound/remote.js";
import { Sharing } from "../sound/sharing.js";
import { onLanguage, translate } from "../i18n.js";
import { showPart } from "./part.js";

/** @type {Way[]} */
const WAYS = ["here", "there", "listen"];

/**
 * The choice, and the state of the server.
 * @param {Instrument} instrument
 */
export function showServer(instrument) {
  const line = new ServerConnection();
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
    sharing?.close();
    sharing = null;
    chosen = way;
    rate = line.status.rate;
    instrument.change(way === "here" ? openAlike : () => Remote.open(line, way === "listen"));
    if (way === "here") sharing = new Sharing(instrument, line);
    if (way === "there") instrument.start(); // a picture needs no touch
    tell();
  }

  /** The sound of this page, with the parameters that its player knows. */
  async function openAlike() {
    const sound = await instrument.openHere();
    for (const { address, row, owned } of TABLE) {
      if (!owned) sound.post(null, facts.kinds.WRITE, row, instrument.player.value(address), 0);
    }
    return sound;
  }

  function tell() {
    const { device, pages, sounds, parts } = line.status;
    for (const { way, button } of buttons) {
      button.setAttribute("aria-pressed", String(way === chosen));
      button.disabled = way === "here" && sounds !== "ready";
    }
    about.textContent = chosen ? translate(`server.${chosen}.about`) : "";
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
  return make("section", { class: "group" }, [
    make("h2", {}, [() => translate("server.name")]),
    choice,
    about,
    state,
  ]);
}
