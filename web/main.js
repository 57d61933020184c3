/** Puts the page together. */

import { find, isServed } from "./elements.js";
import { Bow } from "./hands/bow.js";
import { Fingerboard } from "./hands/fingerboard.js";
import { KeyTuning, setTonic } from "./hands/scale.js";
import { Surface } from "./hands/surface.js";
import { Hands } from "./hands/hands.js";
import { Keys } from "./hands/keys.js";
import { Instrument } from "./instrument.js";
import { Midi } from "./midi.js";
import { Gallery } from "./pictures/picture.js";
import { Score } from "./pictures/score.js";
import { Diagram, Schelleng } from "./pictures/schelleng.js";
import { Spectrum } from "./pictures/spectrum.js";
import { Level, Tuner } from "./pictures/tuner.js";
import { Yehu } from "./pictures/yehu.js";
import { settings } from "./settings.js";
import { MidiLearn } from "./midi_learn.js";
import { showConnections } from "./views/connect.js";
import { showHeader } from "./views/header.js";
import { showRecording } from "./views/recording.js";
import { showParameters } from "./views/parameters.js";
import { showGuide } from "./views/guide.js";
import { showSeeing } from "./views/see.js";
import { beginSound, showSounds } from "./views/sounds.js";
import { showTabs } from "./views/tabs.js";
import { showTunes } from "./views/tunes.js";
import { showPlayingOptions } from "./views/playing_options.js";
import { fillWords, loadWords } from "./i18n.js";

/** The note of a first finger that was lifted before it could sound. */
const FIRST = "first";
const FIRST_MS = 1500;
const FIRST_VELOCITY = 0.63;

/** @typedef {ReturnType<typeof assemble>} Page All that the views work with. */

function assemble() {
  const instrument = new Instrument();
  const hands = new Hands(instrument.player);
  const taught = new MidiLearn(instrument);
  const midi = new Midi(instrument, taught);
  const tuned = new KeyTuning();
  const keys = new Keys(hands, tuned);
  const surface = new Surface(find("stage", HTMLElement), settings.direction);
  const fingerboard = new Fingerboard(find("fingerboard", HTMLElement), hands, tuned, surface);
  const bow = new Bow(find("bow", HTMLElement), hands, surface);
  const yehu = new Yehu(find("yehu", HTMLCanvasElement), fingerboard, bow);
  const score = new Score(find("score", HTMLCanvasElement));
  const schelleng = new Schelleng(find("schelleng", HTMLCanvasElement));
  new Diagram(schelleng, instrument.player);
  const analyser = () => instrument.sound?.analyser ?? null;
  const gallery = new Gallery(() => instrument.state);
  for (const picture of [
    yehu,
    score,
    new Tuner(find("tuner", HTMLCanvasElement), tuned),
    new Level(find("level", HTMLCanvasElement)),
    schelleng,
    new Spectrum(find("spectrum", HTMLCanvasElement), analyser),
  ]) {
    gallery.add(picture);
  }
  return {
    instrument,
    hands,
    tuned,
    keys,
    fingerboard,
    bow,
    surface,
    yehu,
    score,
    gallery,
    taught,
    midi,
    /** Which note is do; null: the inner string. @param {number | null} note */
    setTonic(note) {
      setTonic(note);
      yehu.isStale = true;
    },
  };
}

/** @param {Page} page */
function connect({ instrument, hands, keys, fingerboard, bow, gallery }) {
  if (!isServed) {
    instrument.addEventListener("ready", () => {
      beginSound(instrument.player);
      instrument.prepareHere();
    });
  }
  // Touch screens let sound begin only when a finger is lifted: its note is heard then.
  const lifted = () => {
    if (instrument.sound?.status.running) return;
    instrument.sound?.resume?.();
    const { top } = hands;
    if (!top?.isNote) return;
    hands.touch(FIRST, top.pitch, FIRST_VELOCITY);
    setTimeout(() => hands.lift(FIRST), FIRST_MS);
  };
  window.addEventListener("pointerup", lifted, { capture: true });
  hands.isAssisted = settings.isAssisted;
  fingerboard.isLandingInTune = settings.isLandingInTune;
  // Whoever plays wants to hear it: any hand on the instrument starts the sound.
  hands.addEventListener("play", () => instrument.start());
  keys.addEventListener("silence", () => instrument.silence());
  instrument.addEventListener("silence", () => hands.rest());
  instrument.addEventListener("state", () => {
    if (instrument.state) bow.follow(instrument.state);
    gallery.wake();
  });
}

async function main() {
  const server = isServed ? import("./views/server.js") : null;
  await loadWords();
  fillWords();
  const views = await server;
  find("page", HTMLElement).hidden = false; // measured by what follows
  const page = assemble();
  connect(page);
  showHeader(page);
  showPlayingOptions(page);
  const clear = showTabs(page);
  showSeeing(page);
  showSounds(page);
  const lesson = showTunes(page, clear);
  const heard = showRecording(page);
  showConnections(page);
  views?.showServer(page.instrument); // before anybody can touch it
  showParameters(page);
  showGuide(page, lesson, heard);
}

const worker = document.querySelector('meta[name="yehu-worker"]')?.getAttribute("content");
if (worker && "serviceWorker" in navigator) {
  navigator.serviceWorker.register(worker).catch(() => {}); // it works without
}

main().catch((error) => {
  const notice = find("notice", HTMLElement);
  notice.hidden = false;
  notice.textContent = String(error);
  throw error;
});
