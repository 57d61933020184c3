/** MIDI keyboards, the computer's keyboard, and the state of the sound. */

/** @typedef {import('../main.js').Page} Page */

import { find, make } from "../elements.js";
import { NOTES } from "../hands/keys.js";
import { isNatural, nameOf } from "../hands/scale.js";
import { say } from "../words.js";
import { statusText } from "./header.js";
import { whileShown } from "./tabs.js";

const ALL = "";
const ROWS = [
  ["Digit2", "Digit3", "Digit4", "Digit5", "Digit6", "Digit7"],
  ["KeyQ", "KeyW", "KeyE", "KeyR", "KeyT", "KeyY", "KeyU", "KeyI"],
  ["KeyS", "KeyD", "KeyF", "KeyG", "KeyH", "KeyJ", "KeyK", "KeyL", "Semicolon"],
  ["KeyZ", "KeyX", "KeyC", "KeyV", "KeyB", "KeyN", "KeyM", "Comma", "Period", "Slash"],
];
const SIGNS = { Comma: ",", Period: ".", Slash: "/", Semicolon: ";" };

/** @param {Page} page */
export function showConnections(page) {
  const panel = find("panel-connect", HTMLElement);
  const status = make("p", { class: "soft" });
  whileShown(
    panel,
    () => {
      const known = page.instrument.sound?.status ?? null;
      const backend = known ? ` · ${say(`status.${known.backend}`)} · ${known.rate} Hz` : "";
      status.textContent = statusText(known) + backend;
    },
    500,
  );
  panel.append(
    midi(page),
    keyboard(page),
    make("section", { class: "group" }, [make("h2", {}, [say("connect.sound")]), status]),
  );
  if (document.querySelector('meta[name="yehu-server"]')) {
    import("./server.js").then(({ showServer }) => panel.prepend(showServer(page.instrument)));
  }
}

/** @param {Page} page */
function midi({ instrument }) {
  const select = make("select", { "aria-label": say("connect.midi"), hidden: true });
  const word = make("p", { class: "soft", role: "status" });
  const ask = make("button", { type: "button" }, [say("connect.ask")]);
  ask.disabled = !("requestMIDIAccess" in navigator);
  word.textContent = say(
    ask.disabled ? (window.isSecureContext ? "connect.none" : "connect.insecure") : "connect.about",
  );
  /** Inputs by their order of coming: each has 16 channels of its own. @type {string[]} */
  const ports = [];

  /** @param {MIDIAccess} access */
  function list(access) {
    const chosen = select.value;
    const inputs = [...access.inputs.values()].filter(({ state }) => state === "connected");
    select.replaceChildren(
      make("option", { value: ALL }, [say("connect.all")]),
      ...inputs.map((input) => make("option", { value: input.id }, [input.name ?? input.id])),
    );
    select.value = inputs.some(({ id }) => id === chosen) ? chosen : ALL;
    select.hidden = false;
    word.textContent = inputs.length
      ? say("connect.count", { count: inputs.length })
      : say("connect.waiting");
    for (const input of access.inputs.values()) listen(input);
  }

  /** @param {MIDIInput} input */
  function listen(input) {
    if (!ports.includes(input.id)) ports.push(input.id);
    const port = ports.indexOf(input.id);
    if (input.state === "disconnected") instrument.player.letGoOf(port);
    input.onmidimessage = ({ data }) => {
      const isChosen = select.value === ALL || select.value === input.id;
      if (data && isChosen) instrument.player.midi(data, null, port);
    };
  }

  ask.addEventListener("click", async () => {
    await instrument.start();
    try {
      const access = await navigator.requestMIDIAccess();
      access.onstatechange = () => list(access);
      list(access);
      ask.hidden = true;
    } catch {
      word.textContent = say("connect.refused");
    }
  });
  select.addEventListener("change", () => {
    // Notes of inputs that are no longer listened to would never end.
    ports.forEach((id, port) => {
      if (select.value !== ALL && id !== select.value) instrument.player.letGoOf(port);
    });
  });
  return make("section", { class: "group" }, [
    make("h2", {}, [say("connect.midi")]),
    word,
    ask,
    select,
  ]);
}

/** @param {Page} page */
function keyboard({ keys }) {
  const octave = make("output");
  const tell = () => {
    octave.textContent = say("connect.octave", {
      octave: Math.sign(keys.octave) * Math.abs(keys.octave / 12),
    });
  };
  keys.addEventListener("octave", tell);
  tell();
  const lines = ROWS.map((row, i) =>
    make(
      "div",
      { class: i % 2 ? "line" : "line upper" },
      row.map((code) => key(code)),
    ),
  );
  return make("section", { class: "group" }, [
    make("h2", {}, [say("connect.keyboard")]),
    make("p", { class: "soft" }, [say("connect.keyboard.about")]),
    make("div", { class: "keyboard", "aria-hidden": "true" }, lines),
    octave,
  ]);
}

/** @param {string} code */
function key(code) {
  const note = NOTES.get(code);
  if (note === undefined) return make("span", { class: "key none" });
  const sign = SIGNS[/** @type {keyof typeof SIGNS} */ (code)] ?? code.replace(/Key|Digit/, "");
  return make("span", { class: isNatural(note) ? "key" : "key black" }, [
    make("kbd", {}, [sign]),
    nameOf(note),
  ]);
}
