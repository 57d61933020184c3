/**
 * Plays by the browser's own Web MIDI: keyboards come and go (see alsa_ports.c), and what they send is played.
 *
 * Words: the library to preload, and the FIFO it reads.
 */

import { constants, openSync, writeSync } from "node:fs";
import { commands, open, pass } from "./browser.mjs";

export const hasTabs = true;
export const environment = ([library, fifo]) => ({ LD_PRELOAD: library, YEHU_MIDI_PORTS: fifo });

const [KEYS, PADS] = [20, 21]; // clients of ALSA
const ON = [0x90, 69, 100];
const KINDS = ["BEGIN", "END"];
const OFF = [0x80, 69, 0];
const [PATIENCE, BETWEEN_MS] = [200, 20];

export default async function (browser, url, { words: [, fifo] }) {
  const file = openSync(fifo, constants.O_RDWR);
  /** A record of alsa_ports.c. @param {string} what @param {number} client @param {Iterable<number>} bytes */
  const send = (what, client, bytes = []) => {
    const record = Buffer.alloc(32);
    record.write(what);
    record.set([client, [...bytes].length, ...bytes], 1);
    writeSync(file, record);
  };
  const { page, errors } = await open(browser, url);
  const panel = page.locator("#panel-connect");
  const ask = panel.getByRole("button", { name: "Use MIDI keyboards" });
  const list = panel.getByRole("combobox", { name: "MIDI keyboard" });
  const reads = (/** @type {string} */ text) => panel.getByText(text, { exact: true }).waitFor();
  const heard = [];
  /** What was played until a condition holds, or for a while. @param {(played: any[]) => unknown} isEnough */
  const played = async (isEnough) => {
    heard.length = 0;
    for (let i = 0; i < PATIENCE && !isEnough(heard); i++) {
      heard.push(...(await commands(page)).filter(([kind]) => KINDS.includes(kind)));
      await pass(page, BETWEEN_MS);
    }
    return heard.map(([kind]) => kind);
  };
  const begins = (/** @type {any[]} */ all) => all.some(([kind]) => kind === "BEGIN");
  const ends = (/** @type {any[]} */ all) => all.some(([kind]) => kind === "END");
  const found = {};

  await page.click("#tab-connect");
  await ask.click();
  await panel.getByText("The browser did not allow it").waitFor();
  await browser.grantPermissions(["midi", "midi-sysex"]);
  await ask.click();
  await reads("None is connected yet. Plug one in.");
  send("+", KEYS, Buffer.from("Keys"));
  await reads("Connected: Keys");
  send("m", KEYS, [0xfe]); // active sensing, which is nothing to play
  send("m", KEYS, ON);
  found.begun = await played(begins);
  found.isInvited = await page.isVisible("#invite");
  send("m", KEYS, OFF);
  found.ended = await played(ends);

  // It is pulled out in the middle of a note, and comes back.
  send("m", KEYS, ON);
  await played(begins);
  send("-", KEYS);
  found.pulled = await played(ends);
  await reads("None is connected yet. Plug one in.");
  send("+", KEYS, Buffer.from("Keys"));
  await reads("Connected: Keys");
  send("m", KEYS, ON);
  found.again = await played(begins);
  send("m", KEYS, OFF);
  await played(ends);

  // Of two only the one that was chosen is played, which ends what the other holds.
  send("+", PADS, Buffer.from("Pads"));
  await reads("Connected: Keys, Pads");
  found.names = await list.locator("option").allTextContents();
  send("m", KEYS, ON);
  await played(begins);
  await list.selectOption({ label: "Pads" });
  found.chosen = await played(ends);
  send("m", KEYS, ON);
  send("m", PADS, [0x90, 72, 100]);
  await played(begins);
  found.pitches = heard.filter(([kind]) => kind === "BEGIN").map(([, , pitch]) => pitch);
  send("m", PADS, [0x80, 72, 0]);
  await played(ends);

  // The one that was chosen goes: the other is heard again.
  send("-", PADS);
  await reads("Connected: Keys");
  send("m", KEYS, ON);
  found.left = await played(begins);
  return { ...found, errors };
}
