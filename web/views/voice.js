/** Follows a microphone: whoever hums plays. */

/** @typedef {import('../main.js').Page} Page */

import { allow, make, toggle } from "../elements.js";
import { Voice } from "../pictures/voice.js";
import { find } from "../playing/table.js";
import { onLanguage, translate } from "../i18n.js";

const NEUTRAL = find("/playing/velocity").default;

/** A voice varies by itself, so hands do not; its attacks are the bow's. */
const STEADY = {
  "/playing/variation": 0,
  "/playing/vibrato": 0,
  "/playing/attack": 20,
  "/playing/velocity": NEUTRAL,
};

/**
 * @param {Page} page
 * @returns {HTMLElement}
 */
export function makeVoice({ instrument, gallery }) {
  const { player } = instrument;
  const word = make("p", { class: "soft", role: "status" });
  const canvas = make("canvas", {
    role: "img",
    hidden: true,
    "aria-label": () => translate("voice.picture"),
  });
  gallery.add(new Voice(canvas, () => instrument.sound?.heard ?? NaN));
  /** What is given back at the end. @type {[string, number][]} */
  let before = [];
  const hum = toggle("voice.begin", "keep.stop", (isOn) => (isOn ? begin() : end()));

  async function begin() {
    await instrument.start();
    try {
      await instrument.sound?.voice?.start();
    } catch {
      hum.set(false);
      word.textContent = translate("voice.refused");
      return;
    }
    before = Object.keys(STEADY).map((address) => [address, player.value(address)]);
    for (const [address, value] of Object.entries(STEADY)) player.write(address, value);
    canvas.hidden = false;
    word.textContent = translate("voice.headphones");
  }

  function end() {
    hum.set(false);
    instrument.sound?.voice?.stop();
    for (const [address, value] of before) player.write(address, value);
    before = [];
    word.textContent = "";
  }

  instrument.addEventListener("silence", () => {
    if (before.length) end();
  });
  const judge = () => {
    const isAble =
      Boolean(navigator.mediaDevices) && (!instrument.sound || Boolean(instrument.sound.voice));
    allow(hum.button, isAble ? undefined : translate("missing"));
  };
  instrument.addEventListener("start", judge);
  onLanguage(judge);
  return make("section", { class: "group" }, [
    make("h2", {}, [() => translate("voice")]),
    make("p", { class: "soft" }, [() => translate("voice.about")]),
    make("div", { class: "row" }, [hum.button]),
    word,
    canvas,
  ]);
}
