/** Teaches what the controls of MIDI devices move: one by one, and all that was taught. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../midi_learn.js').MidiLearn} MidiLearn */
/** @typedef {import('../midi.js').Midi} Midi */
/** @typedef {import('../playing/learned.js').LearnedBind} LearnedBind */

import {
  allow,
  download,
  make,
  makeButton,
  makeSwitch,
  note,
  section,
  words,
} from "../elements.js";
import { BEND } from "../playing/sources.js";
import { FREE, GROUPS, find } from "../playing/table.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { nameFor, unitFor, written } from "./slider.js";

/**
 * A button that teaches a control to move a parameter, and a line that names the one that does.
 * @param {string} target
 * @param {MidiLearn} taught
 * @param {Midi} midi
 */
export function makeLearning(target, taught, midi) {
  const button = teacher(() => target, taught, midi, {
    class: "quiet knob",
    title: words("learn"),
  });
  const line = make("p", { class: "soft learned", role: "status" });
  const update = () => {
    const isAwaited = taught.awaited === target;
    const binds = taught.binds.filter((own) => own.target === target);
    const source = binds.map((own) => sourceName(own.source)).join(translate("learn.and"));
    button.setAttribute("aria-label", `${translate("learn")}: ${nameFor(target)}`);
    button.setAttribute("aria-pressed", String(isAwaited));
    button.classList.toggle("taught", binds.length > 0);
    if (isAwaited) line.textContent = translate("learn.move");
    else line.textContent = source ? translate("learn.by", { source }) : "";
  };
  follow(taught, update);
  return [button, line];
}

/** All that was taught, as a part of the panel of connections. @param {Page} page */
export function showLearning({ taught, midi }) {
  const select = make("select", { "aria-label": words("learn.target") }, groups());
  const button = teacher(() => select.value, taught, midi);
  const soft = makeSwitch(words("learn.soft"), taught.isSoft, (isOn) => (taught.isSoft = isOn));
  const alone = makeSwitch(words("learn.alone"), taught.isAlone, (isOn) => (taught.isAlone = isOn));
  const word = make("p", { class: "soft", role: "status" });
  const list = make("ul", { class: "binds", "aria-label": words("learn.list") });
  const save = makeButton(words("learn.save"), () => {
    const { blob, name } = taught.file();
    download(blob, name);
  });
  const saving = make("div", { class: "group" }, [
    make("div", { class: "row" }, [save]),
    note(words("learn.save.about")),
  ]);
  const update = () => {
    const { awaited, found } = taught;
    button.textContent = translate(awaited ? "learn.stop" : "learn");
    button.setAttribute("aria-pressed", String(awaited !== null));
    if (awaited) word.textContent = `${nameFor(awaited)}: ${translate("learn.move")}`;
    else word.textContent = found ? `${nameFor(found.target)}: ${added(found, taught)}` : "";
  };
  /** @type {{key: string, element: HTMLElement, show: (bind: LearnedBind) => void}[]} */
  let rows = [];
  const renew = () => {
    const hadFocus = list.contains(document.activeElement);
    rows = taught.binds.map((bind) => row(bind, taught));
    list.replaceChildren(...rows.map(({ element }) => element));
    list.hidden = saving.hidden = rows.length === 0;
    if (hadFocus) (list.querySelector("button") ?? select).focus();
  };
  follow(taught, update);
  taught.addEventListener("change", () => {
    const { binds } = taught;
    // Rows stay where only their values have changed: somebody may be writing in one.
    if (binds.map(keyOf).join() !== rows.map(({ key }) => key).join()) renew();
    else rows.forEach(({ show }, at) => show(binds[at]));
  });
  onLanguage(renew);
  return section(
    "learn.name",
    note(words("learn.about")),
    make("div", { class: "row" }, [make("div", { class: "wide" }, [select]), button]),
    make("div", {}, [soft, note(words("learn.soft.about"))]),
    make("div", {}, [alone, note(words("learn.alone.about"))]),
    word,
    list,
    saving,
  );
}

/**
 * Call a function now and whenever what is taught changes.
 * @param {MidiLearn} taught
 * @param {() => void} update
 */
function follow(taught, update) {
  for (const event of ["change", "wait"]) taught.addEventListener(event, update);
  onLanguage(update);
}

/**
 * A button that awaits a control, or ends that.
 * @param {() => string} target
 * @param {MidiLearn} taught
 * @param {Midi} midi
 * @param {Record<string, import("../elements.js").Words>} [attributes]
 */
function teacher(target, taught, midi, attributes) {
  const toggle = async () => {
    if (button.ariaPressed === "true") return taught.cancel();
    await midi.open();
    if (midi.isOpen) taught.await(target());
  };
  const button = makeButton("", toggle, attributes);
  if (!midi.isAble) onLanguage(() => allow(button, translate(midi.whyNot)));
  return button;
}

/** The parameters by their groups. */
function groups() {
  const names = GROUPS.filter((name) => FREE.some(({ group }) => group === name));
  return names.map((name) =>
    make(
      "optgroup",
      { label: () => translateOr(`group.${name}`, name) },
      FREE.filter(({ group }) => group === name).map(({ address }) =>
        make("option", { value: address }, [() => nameFor(address)]),
      ),
    ),
  );
}

/** @param {LearnedBind} bind */
function keyOf({ source, target }) {
  return `${source} ${target}`;
}

/**
 * A bind, with the values at its ends, and a button that ends it.
 * @param {LearnedBind} bind
 * @param {MidiLearn} taught
 */
function row(bind, taught) {
  const param = find(bind.target);
  const name = nameFor(bind.target);
  let ends = [param.lo, param.hi];
  const inputs = ends.map((_, end) => {
    const label = `${name}, ${translate(end ? "learn.to" : "learn.from")}`;
    const { lo: min, hi: max } = param;
    const input = make("input", { type: "number", min, max, step: "any", "aria-label": label });
    input.addEventListener("change", () => {
      const value = Math.min(Math.max(input.valueAsNumber, min), max);
      const [from, to] = ends.with(end, Number.isNaN(value) ? ends[end] : value);
      taught.span(bind, from, to);
    });
    return input;
  });
  const show = (/** @type {LearnedBind} */ present) => {
    bind = present;
    ends = [...(bind.span ?? [param.lo, param.hi])];
    inputs.forEach((input, end) => {
      input.value = written(param, ends[end]);
    });
  };
  show(bind);
  const title = translate("learn.forget");
  const forget = makeButton("✕", () => taught.forget(bind), {
    class: "quiet",
    "aria-label": `${title}: ${sourceName(bind.source)}, ${name}`,
    title,
  });
  // Pitch bend moves the bend by the bend range: it has no ends of its own.
  const isByRange = bind.source === BEND && bind.target === "/playing/bend";
  const span = [inputs[0], "–", inputs[1], ` ${unitFor(param.unit)}`];
  const element = make("li", {}, [
    make("span", {}, [make("strong", {}, [sourceName(bind.source)]), ` ${name}`]),
    make("span", { class: "span" }, isByRange ? [] : span),
    forget,
  ]);
  return { key: keyOf(bind), element, show };
}

/**
 * What was added, which controls move the parameter as before, and what this one moves no longer.
 * @param {LearnedBind} bind
 * @param {MidiLearn} taught
 */
function added({ source, target }, taught) {
  const and = translate("learn.and");
  const others = taught.movers(target).filter((other) => other !== source);
  const sources = others.map(sourceName).join(and);
  const targets = taught.lost.map(nameFor).join(and);
  const words = [translate("learn.by", { source: sourceName(source) })];
  if (sources) words.push(translate("learn.keep", { sources }));
  if (targets) words.push(translate("learn.lost", { targets }));
  return words.join(translate("learn.then"));
}

/** The display name of a source. @param {string} source */
export function sourceName(source) {
  return translateOr(`source.${source}`, source.toUpperCase()); // cc 74, nrpn 300
}
