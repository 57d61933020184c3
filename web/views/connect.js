/** MIDI keyboards, the computer's keyboard, and the state of the sound. */

/** @typedef {import('../main.js').Page} Page */

import { find, make } from "../elements.js";
import { NOTES, signOf } from "../hands/keys.js";
import { isNatural, nameOf } from "../hands/scale.js";
import { onLanguage, translate } from "../i18n.js";
import { statusText } from "./header.js";
import { showLearning } from "./learn.js";
import { whileShown } from "./tabs.js";

const ALL = "";
const ROWS = [
  ["Digit2", "Digit3", "Digit4", "Digit5", "Digit6", "Digit7"],
  ["KeyQ", "KeyW", "KeyE", "KeyR", "KeyT", "KeyY", "KeyU", "KeyI"],
  ["KeyS", "KeyD", "KeyF", "KeyG", "KeyH", "KeyJ", "KeyK", "KeyL", "Semicolon"],
  ["KeyZ", "KeyX", "KeyC", "KeyV", "KeyB", "KeyN", "KeyM", "Comma", "Period", "Slash"],
];

/** @param {Page} page */
export function showConnections(page) {
  const panel = find("panel-connect", HTMLElement);
  const status = make("p", { class: "soft" });
  const tell = () => {
    const known = page.instrument.sound?.status ?? null;
    const backend = known ? ` · ${translate(`status.${known.backend}`)} · ${known.rate} Hz` : "";
    status.textContent = statusText(known) + backend;
  };
  whileShown(panel, tell, 500);
  onLanguage(tell);
  panel.append(
    inputs(page),
    showLearning(page),
    keyboard(page),
    make("section", { class: "group" }, [
      make("h2", {}, [() => translate("connect.sound")]),
      status,
    ]),
  );
  if (document.querySelector('meta[name="yehu-server"]')) {
    import("./server.js").then(({ showServer }) => panel.prepend(showServer(page.instrument)));
  }
}

/** @param {Page} page */
function inputs({ midi }) {
  const select = make("select", { "aria-label": () => translate("connect.midi") });
  const word = make("p", { class: "soft", role: "status" });
  const ask = make("button", { type: "button" }, [() => translate("connect.ask")]);
  ask.disabled = !midi.isAble;
  ask.addEventListener("click", () => midi.open());
  select.addEventListener("change", () => midi.choose(select.value));
  const tell = () => {
    const { inputs: connected } = midi;
    select.replaceChildren(
      make("option", { value: ALL }, [translate("connect.all")]),
      ...connected.map(({ id, name }) => make("option", { value: id }, [name ?? id])),
    );
    select.value = midi.chosen;
    select.hidden = !midi.isOpen;
    ask.hidden = midi.isOpen;
    if (!midi.isAble) word.textContent = translate(midi.whyNot);
    else if (midi.isRefused) word.textContent = translate("connect.refused");
    else if (!midi.isOpen) word.textContent = translate("connect.about");
    else if (connected.length === 0) word.textContent = translate("connect.waiting");
    else word.textContent = translate("connect.count", { count: connected.length });
  };
  midi.addEventListener("change", tell);
  onLanguage(tell);
  return make("section", { class: "group" }, [
    make("h2", {}, [() => translate("connect.midi")]),
    word,
    ask,
    select,
  ]);
}

/** @param {Page} page */
function keyboard({ keys }) {
  const octave = make("output");
  const tell = () => {
    octave.textContent = translate("connect.octave", {
      octave: Math.sign(keys.octave) * Math.abs(keys.octave / 12),
    });
  };
  keys.addEventListener("octave", tell);
  onLanguage(tell);
  const lines = ROWS.map((row, i) =>
    make(
      "div",
      { class: i % 2 ? "line" : "line upper" },
      row.map((code) => key(code)),
    ),
  );
  return make("section", { class: "group" }, [
    make("h2", {}, [() => translate("connect.keyboard")]),
    make("p", { class: "soft" }, [() => translate("connect.keyboard.about")]),
    make("div", { class: "keyboard", "aria-hidden": "true" }, lines),
    octave,
  ]);
}

/** @param {string} code */
function key(code) {
  const note = NOTES.get(code);
  if (note === undefined) return make("span", { class: "key none" });
  return make("span", { class: isNatural(note) ? "key" : "key black" }, [
    make("kbd", {}, [signOf(code)]),
    nameOf(note),
  ]);
}
