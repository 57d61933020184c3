/** Records the sound, and keeps what was played, to be played again. */

/** @typedef {import('../main.js').Page} Page */
/** @typedef {import('../instrument.js').Instrument} Instrument */

import {
  allow,
  download,
  find,
  make,
  makeButton,
  note,
  section,
  toggle,
  whileShown,
  words,
} from "../elements.js";
import { CaptureWriter, Replayer, fileOf, notesAndGestures, readCapture } from "../capture.js";
import { isPublic, linkOf, readLink } from "../link.js";
import { onLanguage, translate, translateOr } from "../i18n.js";
import { find as findParameter } from "../playing/table.js";
import { nameFor } from "./slider.js";

const MAX_NAMED = 4; // settings in a line

/**
 * @param {Page} page
 * @returns {Promise<void>} what the page's address brought was heard, or somebody plays instead
 */
export function showRecording(page) {
  const { element, heard } = performances(page);
  find("panel-keep", HTMLElement).append(element, recording(page.instrument));
  return heard;
}

/** A name for a file of now. @param {string} ending */
function fileName(ending) {
  const stamp = new Date().toISOString().slice(0, 19).replace(/[T:]/g, "-");
  return `yehu-${stamp}.${ending}`;
}

/**
 * A button that keeps something of what sounds, until it is pressed again or another sound takes its place; and for how long.
 * @template T
 * @param {Instrument} instrument
 * @param {string} off key of its text
 * @param {string} on
 * @param {(sound: Instrument["sound"]) => {start: () => void, stop: () => T} | null | undefined} choose
 * @param {(kept: Awaited<T> | null) => unknown} report null: it begins
 */
function keeping(instrument, off, on, choose, report) {
  /** @type {ReturnType<typeof choose>} */
  let keeper;
  let begun = 0;
  const time = make("output", { class: "soft" });
  const tell = () => {
    if (begun) time.textContent = clock((performance.now() - begun) / 1000);
  };
  const one = toggle(off, on, async (isOn) => {
    if (!isOn) {
      begun = 0;
      if (keeper) await report(await keeper.stop());
      return;
    }
    await instrument.start();
    keeper = choose(instrument.sound);
    if (!keeper || !one.isOn) return one.set(false);
    report(null);
    keeper.start();
    begun = performance.now();
    tell();
  });
  instrument.addEventListener("way", () => one.isOn && one.press());
  whileShown(time, tell);
  return { button: one.button, time };
}

/** @param {Instrument} instrument */
function recording(instrument) {
  const { button, time } = keeping(
    instrument,
    "keep.record",
    "keep.record.stop",
    (sound) => sound?.record,
    (blob) => blob && download(blob, fileName("wav")),
  );
  const lack = judge(instrument, button, (sound) => !sound || Boolean(sound.record));
  const row = make("div", { class: "row" }, [button, time]);
  return section("keep.sound", note(words("keep.sound.about")), row, lack);
}

/** @param {Page} page */
function performances({ instrument, hands }) {
  const word = make("p", { class: "soft", role: "status" });
  const offer = make("div", { class: "row" });
  const { button: keep, time } = keeping(
    instrument,
    "keep.begin",
    "keep.begin.stop",
    (sound) => sound?.keep && new CaptureWriter(instrument.player, sound),
    async (kept) => {
      offer.replaceChildren();
      word.textContent = "";
      if (kept) await showKept(kept);
    },
  );
  const label = words("keep.load");
  const input = make("input", {
    type: "file",
    accept: ".jsonl",
    hidden: true,
    "aria-label": label,
  });
  /** @type {Replayer | null} */
  let replayer = null;
  let playing = ""; // what is said of it
  const load = toggle("keep.load", "keep.stop", (isOn) => {
    load.set(replayer !== null);
    if (!isOn) replayer?.stop();
    else input.click();
  });

  /**
   * @param {import('../capture.js').Performance} performance
   * @param {string} name what is said of it
   * @returns {{left: string, replayer: Replayer}} also what is said of what is left out
   */
  function play(performance, name = "") {
    replayer?.stop();
    const isServers = ["remote", "listening"].includes(instrument.sound?.status.backend ?? "");
    const { played, leftOut } = notesAndGestures(performance, isServers);
    const left = leftOutLine(leftOut);
    playing = [name, left].filter((text) => text !== "").join(" · ");
    word.textContent = playing;
    const one = new Replayer(instrument, played);
    replayer = one;
    load.set(true);
    one.addEventListener("end", () => {
      if (replayer !== one) return;
      replayer = null;
      load.set(false);
      if (word.textContent === playing) word.textContent = ""; // a refused file stays said
    });
    return { left, replayer: one };
  }

  /**
   * Offer what was kept: as a link, if it is short, and as a file.
   * @param {import('../capture.js').Performance & {frames: number}} kept
   */
  async function showKept(kept) {
    const link = await linkOf(kept);
    const save = async () => download(await fileOf(kept), fileName("jsonl"));
    offer.replaceChildren(makeButton(translate("keep.save"), save));
    word.textContent = link ? "" : translate("keep.long");
    if (!link) return;
    const isForAll = isPublic(new URL(link).hostname);
    if (!isForAll) word.textContent = translate("keep.local");
    const copy = async () => {
      await navigator.clipboard?.writeText(link).catch(() => {});
      word.textContent = translate(isForAll ? "keep.copied" : "keep.local");
    };
    const label = translate("keep.link");
    offer.prepend(
      make("input", { type: "text", readonly: true, value: link, "aria-label": label }),
      makeButton(translate("keep.copy"), copy, { class: "main" }),
    );
  }

  input.addEventListener("change", async () => {
    const file = input.files?.[0];
    input.value = "";
    if (!file) return;
    try {
      const read = await readCapture(file);
      await instrument.start();
      const { players } = read;
      const { name } = file;
      play(read, players > 1 ? translate("keep.one", { name, count: players }) : name);
    } catch {
      word.textContent = translate("keep.wrong", { name: file.name });
    }
  });
  instrument.addEventListener("silence", () => replayer?.stop());
  // Whoever plays while it plays goes on from there.
  hands.addEventListener("play", () => replayer?.yield());
  const heard = invite(instrument, play);
  const lack = judge(instrument, keep, (sound) => !sound || Boolean(sound.keep));
  const row = make("div", { class: "row" }, [keep, time, load.button, input]);
  const about = note(words("keep.performance.about"));
  return { element: section("keep.performance", about, row, lack, offer, word), heard };
}

/**
 * Invite to listen to what the address of the page brings, as often as one likes, until it is closed.
 * @param {Instrument} instrument
 * @param {(performance: import('../capture.js').Performance) => {left: string, replayer: Replayer}} play
 */
async function invite(instrument, play) {
  const invitation = find("invite", HTMLElement);
  const bar = find("brought", HTMLElement);
  try {
    const brought = await readLink(location.hash);
    if (brought === null) return;
    const { commands, rate } = brought;
    const time = clock(Math.ceil((commands.at(-1)?.frame ?? 0) / rate));
    const said = make("p", { role: "status" }, [words("keep.brought")]);
    /** @type {Replayer | null} */
    let replayer = null;
    const change = async (/** @type {boolean} */ isOn) => {
      if (!isOn) return replayer?.stop();
      await instrument.start(); // while the touch counts
      if (!instrument.sound) return listen.set(false);
      const played = play(brought);
      replayer = played.replayer;
      if (played.left) said.textContent = played.left;
      replayer.addEventListener("end", () => listen.set(false), { once: true });
    };
    const listen = toggle("keep.listen", "keep.stop", change, { time });
    listen.button.className = "main";
    listen.button.id = "listen";
    bar.append(said, listen.button);
    bar.hidden = false;
    invitation.hidden = true;
    const begin = () => !bar.hidden && !listen.isOn && listen.press();
    find("start", HTMLElement).addEventListener("begin", begin);
    await new Promise((resolve) => {
      const close = () => resolve(true);
      bar.append(makeButton(words("guide.close"), close, { class: "quiet" }));
    });
    if (listen.isOn) listen.press();
    bar.hidden = true;
  } catch {
    invitation.textContent = translate("keep.broken");
  }
}

/**
 * What a link or file brings that is not played, by name; empty where all is.
 * @param {readonly string[]} addresses
 */
function leftOutLine(addresses) {
  if (addresses.length === 0) return "";
  const names = addresses.slice(0, MAX_NAMED).map((address) => {
    const { group } = findParameter(address);
    return `${nameFor(address)} (${translateOr(`group.${group}`, group)})`;
  });
  if (addresses.length > MAX_NAMED) names.push("…");
  return translate("keep.left", { names: names.join(translate("learn.and")) });
}

/**
 * Withhold a button where the page, or the sound once it is there, cannot do what it says.
 * @param {Instrument} instrument
 * @param {HTMLButtonElement} button
 * @param {(sound: Instrument["sound"]) => boolean} isAble
 * @returns {HTMLElement} which says so
 */
export function judge(instrument, button, isAble) {
  const lack = make("p", { class: "soft" });
  const update = () => {
    lack.hidden = isAble(instrument.sound);
    lack.textContent = lackOf(instrument);
    allow(button, lack.hidden ? undefined : lack.textContent);
  };
  for (const event of ["start", "way"]) instrument.addEventListener(event, update);
  onLanguage(update);
  return lack;
}

/** Why the sound cannot do something, and what helps. @param {Instrument} instrument */
export function lackOf({ sound }) {
  return translate(sound && !sound.record ? "missing.remote" : "missing");
}

/** @param {number} seconds */
export function clock(seconds) {
  return `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;
}
