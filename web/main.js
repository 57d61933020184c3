/** Puts the page together. */

import { find } from "./elements.js";
import { Bow } from "./hands/bow.js";
import { Diagram } from "./hands/schelleng.js";
import { Fingerboard } from "./hands/fingerboard.js";
import { Hands } from "./hands/hands.js";
import { Keys } from "./hands/keys.js";
import { KeyTuning } from "./hands/key_tuning.js";
import { Instrument } from "./instrument.js";
import { Midi } from "./midi.js";
import { Board } from "./pictures/fingerboard.js";
import { Bowing } from "./pictures/bow.js";
import { Level } from "./pictures/level.js";
import { Gallery } from "./pictures/picture.js";
import { Schelleng } from "./pictures/schelleng.js";
import { Spectrum } from "./pictures/spectrum.js";
import { Strings } from "./pictures/strings.js";
import { Tuner } from "./pictures/tuner.js";
import { settings } from "./settings.js";
import { MidiLearn } from "./midi_learn.js";
import { showConnections } from "./views/connect.js";
import { showHeader } from "./views/header.js";
import { showRecording } from "./views/recording.js";
import { showParameters } from "./views/parameters.js";
import { showSeeing } from "./views/see.js";
import { showSounds } from "./views/sounds.js";
import { showTabs } from "./views/tabs.js";
import { showTunes } from "./views/tunes.js";
import { showPlayingOptions } from "./views/playing_options.js";
import { fillWords, loadWords } from "./i18n.js";

/**
 * All that the views work with.
 * @typedef {object} Page
 * @property {Instrument} instrument
 * @property {Hands} hands
 * @property {KeyTuning} tuned
 * @property {Keys} keys
 * @property {Fingerboard} fingerboard
 * @property {Bow} bow
 * @property {Board} board
 * @property {Strings} strings
 * @property {Gallery} gallery
 * @property {MidiLearn} taught
 * @property {Midi} midi
 */

/** @returns {Page} */
function assemble() {
  const instrument = new Instrument();
  const hands = new Hands(instrument.player);
  const taught = new MidiLearn(instrument);
  const midi = new Midi(instrument, taught);
  const tuned = new KeyTuning();
  const keys = new Keys(hands, tuned);
  const fingerboard = new Fingerboard(find("fingerboard", HTMLCanvasElement), hands, tuned);
  const bow = new Bow(find("bow", HTMLCanvasElement), hands);
  const board = new Board(fingerboard.element, fingerboard);
  const strings = new Strings(find("strings", HTMLCanvasElement));
  const gallery = new Gallery(() => instrument.state);
  gallery.add(board);
  gallery.add(new Bowing(bow.element, bow));
  gallery.add(strings);
  gallery.add(new Tuner(find("tuner", HTMLCanvasElement)));
  gallery.add(new Level(find("level", HTMLCanvasElement)));
  const schelleng = new Schelleng(find("schelleng", HTMLCanvasElement));
  gallery.add(schelleng);
  new Diagram(schelleng, instrument.player);
  gallery.add(
    new Spectrum(find("spectrum", HTMLCanvasElement), () => instrument.sound?.analyser ?? null),
  );
  return {
    instrument,
    hands,
    tuned,
    keys,
    fingerboard,
    bow,
    board,
    strings,
    gallery,
    taught,
    midi,
  };
}

/** @param {Page} page */
function connect({ instrument, hands, keys, fingerboard, bow }) {
  hands.isAssisted = settings.isAssisted;
  fingerboard.isLandingInTune = settings.isLandingInTune;
  // Whoever plays wants to hear it: any hand on the instrument starts the sound.
  for (const hand of [keys, fingerboard, bow]) {
    hand.addEventListener("play", () => instrument.start());
  }
  keys.addEventListener("silence", () => instrument.silence());
  instrument.addEventListener("silence", () => hands.rest());
  instrument.addEventListener("start", () => {
    instrument.sound?.addEventListener("state", () => {
      if (instrument.state) bow.follow(instrument.state);
    });
  });
}

async function main() {
  await loadWords();
  fillWords(document);
  find("page", HTMLElement).hidden = false; // measured by what follows
  const page = assemble();
  connect(page);
  showHeader(page);
  showPlayingOptions(page);
  showTabs(page);
  showSeeing(page);
  showSounds(page);
  showTunes(page);
  showRecording(page);
  showConnections(page);
  showParameters(page);
}

main().catch((error) => {
  const notice = find("notice", HTMLElement);
  notice.hidden = false;
  notice.textContent = String(error);
  throw error;
});
