/** Where the sound of a page that has a server is made, and where it is heard. */

/** @typedef {import('../instrument.js').Instrument} Instrument */
/** @typedef {'here' | 'there' | 'listen'} Way */

import facts from "../facts.js";
import { find, make, makeChoice, section, words } from "../elements.js";
import { nameOf } from "../hands/scale.js";
import { FREE } from "../playing/table.js";
import { remember, settings } from "../settings.js";
import { ServerConnection } from "../sound/server_connection.js";
import { Remote } from "../sound/remote.js";
import { Sharing } from "../sound/sharing.js";
import { onLanguage, translate } from "../i18n.js";

/** @type {Way[]} */
const WAYS = ["here", "there", "listen"];
const { LOWEST_NOTE, HIGHEST_NOTE } = facts.notes;
const FIRST_MS = 1000; // a server that is away is not waited for any longer

/** The choice, and the state of the server. @param {Instrument} instrument */
export function showServer(instrument) {
  const connection = new ServerConnection();
  instrument.others = connection;
  instrument.way = () => connection.ready; // where to sound is chosen once the server has sent its state
  showPart(connection);
  const each = WAYS.map((way) =>
    make("p", { class: "soft" }, [
      make("b", {}, [words(`way.${way}`)]),
      ": ",
      words(`way.${way}.about`),
    ]),
  );
  const about = make("p", { class: "soft" });
  const state = make("p", { class: "soft", role: "status" });
  /** @type {Way | null} */
  let chosen = null;
  let rate = 0;
  /** @type {Sharing | null} */
  let sharing = null;
  const choice = makeChoice(words("server.name"), WAYS, "way", (way) => {
    remember({ way });
    choose(way);
    instrument.start(); // while the touch counts
  });

  /** @param {Way} way */
  function choose(way) {
    chosen = way;
    rate = connection.status.rate;
    const before = sharing;
    sharing = null;
    instrument.change(way === "here" ? openAlike : () => Remote.open(connection, way === "listen"));
    before?.close();
    if (way === "here") sharing = new Sharing(instrument, connection);
    if (way === "there") instrument.start(); // a picture needs no touch
    update();
  }

  /** The sound of this page, with the parameters that the server has. */
  async function openAlike() {
    const sound = await instrument.openHere();
    await Promise.race([connection.first, new Promise((resolve) => setTimeout(resolve, FIRST_MS))]);
    for (const { address, index } of FREE) {
      const value = connection.wasSet(address) ?? instrument.player.value(address);
      sound.post(null, facts.kinds.WRITE, index, value, 0);
    }
    return sound;
  }

  const canBeHere = () => facts.isYehu && connection.status.sounds === "ready";

  function update() {
    const { device, pages, sounds, parts } = connection.status;
    choice.show(chosen ?? "");
    choice.buttons[WAYS.indexOf("here")].disabled = !canBeHere();
    document.documentElement.dataset.role = connection.status.role; // hides what the owner alone may do
    const { role } = connection.status;
    about.textContent = [
      role === "own" ? "" : translate(`server.role.${role}`),
      parts > 1 ? translate("server.parts") : "",
    ].join(" ");
    const own = {
      preparing: translate("server.preparing"),
      ready: "",
      none: translate("server.impossible"),
    };
    const sentences = [
      device ? translate("server.device", { device }) : translate("server.silent"),
      translate("server.pages", { count: pages }),
      facts.isYehu
        ? own[sounds]
        : translate("server.other", { low: nameOf(LOWEST_NOTE), high: nameOf(HIGHEST_NOTE) }),
    ];
    state.textContent = connection.isOpen
      ? sentences.filter(Boolean).join(" ")
      : translate("server.gone");
  }

  connection.addEventListener("status", () => {
    const { device } = connection.status;
    if (chosen === null) {
      const first = WAYS.find((way) => way === settings.way) ?? (device ? "there" : "listen");
      choose(first === "here" && !canBeHere() ? "there" : first);
    } else if (chosen === "listen" && rate !== connection.status.rate) {
      choose(chosen); // another server, at another rate
      instrument.start();
    }
    update();
  });
  onLanguage(update);
  connection.addEventListener("break", () => {
    if (chosen !== "here") instrument.silence(); // the server has ended what this page held
    update();
  });
  find("panel-connect", HTMLElement).prepend(
    section("server.name", choice.element, ...each, about, state, askForPin(connection)),
  );
}

/**
 * A question for the PIN, which shows where the server refuses the one it got.
 * @param {ServerConnection} connection
 */
function askForPin(connection) {
  const label = words("server.pin");
  const pin = make("input", { inputmode: "numeric", "aria-label": label });
  const send = make("button", {}, [words("server.pin.send")]);
  const form = make("form", { hidden: true }, [make("p", {}, [label]), pin, send]);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    reload("pin", pin.value.trim());
  });
  connection.addEventListener("refuse", () => {
    form.hidden = false;
    // Else nobody would see it; a click on the tab that is shown would close it.
    if (find("panel-connect", HTMLElement).hidden) find("tab-connect", HTMLElement).click();
    pin.focus();
  });
  return form;
}

/**
 * The choice of the part that this page plays, where a server has several.
 * @param {ServerConnection} connection
 */
function showPart(connection) {
  const select = find("part", HTMLSelectElement);
  const update = () => {
    const { part, parts } = connection.status;
    select.hidden = parts < 2;
    const numbers = Array.from({ length: parts }, (_, i) => String(i + 1));
    if (select.length !== parts) {
      select.replaceChildren(...numbers.map((number) => new Option("", number)));
    }
    for (const option of select.options)
      option.text = translate("part.of", { part: option.value, parts });
    select.value = String(part);
    document.title = parts < 2 ? translate("title") : `${translate("title")} ${part}`;
  };
  // A player of its own, that knows nothing of the part before.
  select.addEventListener("change", () => reload("part", select.value));
  connection.addEventListener("status", update);
  onLanguage(update);
}

/**
 * Load this page with another word in its address.
 * @param {string} name
 * @param {string} value
 */
function reload(name, value) {
  const url = new URL(location.href);
  url.searchParams.set(name, value);
  location.assign(url);
}
