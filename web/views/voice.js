/** Follows a microphone: whoever hums plays. */

/** @typedef {import('../main.js').Page} Page */

import { find, make, makeSwitch, note, section, toggle, words } from "../elements.js";
import { Voice } from "../pictures/voice.js";
import facts from "../facts.js";
import { translate } from "../i18n.js";
import { judge, lackOf } from "./recording.js";

/** @type {[string, number][]} */
const AS_IT_SINGS = Object.entries(facts.asItSings);

/**
 * @param {Page} page
 * @returns {HTMLElement}
 */
export function makeVoice({ instrument, gallery, tuned }) {
  const { player } = instrument;
  const word = make("p", { class: "soft", role: "status" });
  const canvas = make("canvas", {
    role: "img",
    hidden: true,
    "aria-label": words("voice.picture"),
  });
  const lines = note(words("voice.lines"));
  lines.hidden = true;
  gallery.add(new Voice(canvas, () => instrument.sound?.heard ?? NaN));
  /** What is given back at the end. @type {[string, number][]} */
  let before = [];
  const hum = toggle("voice.begin", "keep.stop", (isOn) => (isOn ? begin() : end()));

  let isTuned = false;
  const correct = makeSwitch(words("voice.tuned"), isTuned, (isOn) => {
    isTuned = isOn;
    if (before.length) follow();
  });

  function follow() {
    instrument.sound?.voice?.follow(isTuned ? tuned.pitches : []);
  }

  async function begin() {
    await instrument.start();
    const voice = instrument.sound?.voice;
    let lack = voice ? "" : lackOf(instrument);
    if (hum.isOn) await voice?.start().catch(() => (lack = translate("voice.refused"))); // the browser asks
    if (lack || !hum.isOn || voice !== instrument.sound?.voice) {
      voice?.stop();
      hum.set(false);
      word.textContent = lack;
      return;
    }
    before = AS_IT_SINGS.map(([address]) => [address, player.value(address)]);
    for (const [address, value] of AS_IT_SINGS) player.write(address, value);
    follow();
    canvas.hidden = lines.hidden = false;
    find("invite", HTMLElement).hidden = true; // it plays without a touch
    word.textContent = translate("voice.headphones");
  }

  function end() {
    hum.set(false);
    instrument.sound?.voice?.stop();
    for (const [address, value] of before) player.write(address, value);
    before = [];
    word.textContent = "";
  }

  instrument.addEventListener("silence", () => hum.isOn && end());
  const isAble = (/** @type {typeof instrument.sound} */ sound) =>
    Boolean(navigator.mediaDevices) && (!sound || Boolean(sound.voice));
  const lack = judge(instrument, hum.button, isAble);
  const row = make("div", { class: "row" }, [hum.button, correct]);
  return section("voice", note(words("voice.about")), row, lack, word, canvas, lines);
}
