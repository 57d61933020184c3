/** MIDI keyboards, the computer's keyboard, and the state of the sound. */

/** @typedef {import('../main.js').Page} Page */

import { find, make, makeSwitch } from "../elements.js";
import { NOTES, signOf } from "../hands/keys.js";
import { isNatural, nameOf } from "../hands/scale.js";
import { onLanguage, translate } from "../i18n.js";
import { remember, settings } from "../settings.js";
import { statusText } from "./header.js";
import { showLearning } from "./learn.js";
import { whileShown } from "./tabs.js";

const ALL = "";
const MINUTE = 60_000; // ms
const MOST_COUNTED = 999;
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
  const gaps = make("p", { class: "soft", role: "status", hidden: true });
  const buffer = makeSwitch(
    () => translate("connect.buffer"),
    settings.isBuffered,
    (isBuffered) => {
      remember({ isBuffered });
      const { way } = page.instrument;
      page.instrument.change(() => way());
      page.instrument.start();
    },
  );
  const recent = dropoutsOf(page.instrument);
  const tell = () => {
    const known = page.instrument.sound?.status ?? null;
    const backend = known ? ` · ${translate(`status.${known.backend}`)} · ${known.rate} Hz` : "";
    status.textContent = statusText(known) + backend;
    const count = recent();
    const isHere = known?.backend === "worklet" || known?.backend === "script";
    gaps.hidden = count === 0;
    gaps.textContent = `${translate("connect.dropouts", { count })} ${translate(
      isHere ? "connect.dropouts.here" : "connect.dropouts.server",
    )}`;
    buffer.hidden = !isHere || (count === 0 && !settings.isBuffered);
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
      gaps,
      buffer,
    ]),
  );
}

/**
 * Counts the drop-outs of the last minute.
 * @param {import('../instrument.js').Instrument} instrument
 */
function dropoutsOf(instrument) {
  /** @type {number[]} */
  let times = []; // ms
  let [known, before] = [instrument.sound, 0];
  const count = () => {
    const now = performance.now();
    const { sound } = instrument;
    if (sound !== known) [known, before] = [sound, sound?.status.dropouts ?? 0];
    const all = sound?.status.dropouts ?? 0;
    times.push(
      ...Array.from({ length: Math.max(Math.min(all - before, MOST_COUNTED), 0) }, () => now),
    );
    before = all;
    times = times.filter((time) => now - time < MINUTE).slice(-MOST_COUNTED);
    return times.length;
  };
  setInterval(count, 1000);
  return count;
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
