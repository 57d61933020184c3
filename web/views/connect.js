/** MIDI keyboards, a voice, the computer's keyboard, and the state of the sound. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../instrument.js').Instrument} Instrument */

import {
  find,
  make,
  makeButton,
  makeSelect,
  makeSwitch,
  note,
  section,
  whileShown,
  words,
} from "../elements.js";
import { NOTES, signOf } from "../hands/keys.js";
import { isNatural, nameOf } from "../hands/scale.js";
import { onLanguage, translate } from "../i18n.js";
import { remember, settings } from "../settings.js";
import { statusText } from "./header.js";
import { showLearning } from "./learn.js";
import { makeVoice } from "./voice.js";

const ALL = "";
const MINUTE = 60_000; // ms
const MAX_COUNTED = 999;
const ROWS = [
  ["Digit2", "Digit3", "Digit4", "Digit5", "Digit6", "Digit7"],
  ["KeyQ", "KeyW", "KeyE", "KeyR", "KeyT", "KeyY", "KeyU", "KeyI"],
  ["KeyS", "KeyD", "KeyF", "KeyG", "KeyH", "KeyJ", "KeyK", "KeyL", "Semicolon"],
  ["KeyZ", "KeyX", "KeyC", "KeyV", "KeyB", "KeyN", "KeyM", "Comma", "Period", "Slash"],
];

/** @param {Page} page */
export function showConnections(page) {
  find("panel-connect", HTMLElement).append(
    inputs(page),
    makeVoice(page),
    keyboard(page),
    showLearning(page),
    sound(page.instrument),
  );
}

/** The state of the sound, and what helps against drop-outs. @param {Instrument} instrument */
function sound(instrument) {
  const status = make("p", { class: "soft" });
  const gaps = make("p", { class: "soft", role: "status", hidden: true });
  const buffer = makeSwitch(words("connect.buffer"), settings.isBuffered, (isBuffered) => {
    remember({ isBuffered });
    const { way } = instrument;
    instrument.change(() => way());
    instrument.start();
  });
  const recent = dropoutsOf(instrument);
  const update = () => {
    const { backend, rate } = instrument.sound?.status ?? {};
    status.textContent = statusText(instrument);
    if (backend) status.textContent += ` · ${translate(`status.${backend}`)} · ${rate} Hz`;
    const count = recent();
    const isHere = backend === "worklet" || backend === "script";
    const advice = translate(isHere ? "connect.dropouts.here" : "connect.dropouts.server");
    gaps.hidden = count === 0;
    gaps.textContent = `${translate("connect.dropouts", { count })} ${advice}`;
    buffer.hidden = !isHere || (count === 0 && !settings.isBuffered);
  };
  whileShown(status, update, 500);
  onLanguage(update);
  return section("connect.sound", status, gaps, buffer);
}

/** Counts the drop-outs of the last minute. @param {Instrument} instrument */
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
      ...Array.from({ length: Math.max(Math.min(all - before, MAX_COUNTED), 0) }, () => now),
    );
    before = all;
    times = times.filter((time) => now - time < MINUTE).slice(-MAX_COUNTED);
    return times.length;
  };
  setInterval(count, 1000);
  return count;
}

/** @param {Page} page */
function inputs({ midi }) {
  const choose = (/** @type {string} */ id) => midi.choose(id);
  const select = makeSelect(words("connect.midi"), [], choose);
  const word = make("p", { class: "soft", role: "status" });
  const ask = makeButton(words("connect.ask"), () => midi.open());
  ask.disabled = !midi.isAble;
  const statusText = () => {
    if (!midi.isAble) return translate(midi.whyNot);
    if (midi.isRefused) return translate("connect.refused");
    if (!midi.isOpen) return translate("connect.about");
    const names = midi.inputs.map(({ name, id }) => name ?? id).join(", ");
    return translate(names ? "connect.names" : "connect.waiting", { names });
  };
  const update = () => {
    select.replaceChildren(
      new Option(translate("connect.all"), ALL),
      ...midi.inputs.map(({ id, name }) => new Option(name ?? id, id)),
    );
    select.value = midi.chosen;
    select.hidden = !midi.isOpen;
    ask.hidden = midi.isOpen;
    word.textContent = statusText();
  };
  midi.addEventListener("change", update);
  onLanguage(update);
  return section("connect.midi", word, ask, select);
}

/** @param {Page} page */
function keyboard({ keys }) {
  const octave = make("output");
  const update = () => {
    octave.textContent = translate("connect.octave", { octave: keys.octave / 12 });
  };
  keys.addEventListener("octave", update);
  onLanguage(update);
  const lines = ROWS.map((row, i) =>
    make("div", { class: i % 2 ? "line" : "line upper" }, row.map(key)),
  );
  return section(
    "connect.keyboard",
    note(words("connect.keyboard.about")),
    make("div", { class: "keyboard", "aria-hidden": "true" }, lines),
    octave,
  );
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
