/**
 * Performances in links and files are bounded, and reach nothing but the sound.
 *
 * WEB is the page's folder, MANY how many spoilt links are read.
 */

import assert from "node:assert/strict";
import test from "node:test";
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";
import { deflateRawSync, inflateRawSync } from "node:zlib";

globalThis.document = { querySelector: () => null };
globalThis.location = { origin: "http://a", pathname: "/", search: "" };
globalThis.AudioWorkletNode ??= class {};
const web = pathToFileURL(`${resolve(process.env.WEB ?? "web")}/`);
const { default: facts } = await import(new URL("facts.js", web).href);
const { checked, notesAndGestures, readCapture } = await import(new URL("capture.js", web).href);
const { isPublic, linkOf, readLink } = await import(new URL("link.js", web).href);

const { RAMP, WRITE, HOLD, BEGIN, EXPRESS, END, RELEASE, STOP } = facts.kinds;
const RATE = 1000;

function performance(commands) {
  return { rate: RATE, values: {}, commands, players: 1 };
}

function notes(count, apart) {
  return Array.from({ length: count }, (_, n) => ({
    frame: n * apart,
    kind: n % 2 ? END : BEGIN,
    index: 5,
    value: 69,
    other: 0.5,
  }));
}

function fragmentOf(bytes) {
  return `#play=${Buffer.from(bytes).toString("base64url")}`;
}

async function refuses(action, what) {
  await assert.rejects(async () => action(), undefined, what);
}

test("a link brings what was played", async () => {
  const played = performance([
    ...notes(20, 100),
    { frame: 2000, kind: EXPRESS, index: 3, value: 0.25, other: 0 },
  ]);
  const read = await readLink(new URL(await linkOf(played)).hash);
  assert.deepEqual(read.commands, played.commands);
});

test("of what is brought notes and gestures are played, and what is left out is named", () => {
  const index = (address) => facts.parameters.findIndex((param) => param.address === address);
  const of = (kind, address) => ({ frame: 0, kind, index: index(address), value: 0.5, other: 0 });
  const [vibrato, room] = ["/playing/vibrato", "/room/size"];
  const settings = [of(RAMP, vibrato), of(HOLD, vibrato), of(WRITE, room), of(EXPRESS, room)];
  const gestures = [of(WRITE, vibrato), of(EXPRESS, vibrato), ...notes(4, 10)];
  const brought = performance([...settings, ...gestures]);
  brought.values = { [vibrato]: 10, [room]: 30, "/output/gain": 0 };
  const { played, leftOut } = notesAndGestures(brought, true);
  assert.deepEqual(played.commands, gestures);
  assert.deepEqual(Object.keys(played.values), [vibrato]);
  assert.deepEqual(leftOut, [room, vibrato]); // the gain is what it is by itself
  const here = notesAndGestures(brought, false);
  assert.deepEqual(here.played.commands, [...settings.slice(2), ...gestures]);
  assert.deepEqual(here.played.values, brought.values);
});

test("what is brought frees nothing that is held and ends no notes of others", () => {
  const of = (kind, value) => ({ frame: 0, kind, index: 0, value, other: 0 });
  const brought = performance([of(RELEASE, 0), of(STOP, 1)]);
  const atServer = notesAndGestures(brought, true);
  assert.deepEqual(atServer.played.commands, [of(RELEASE, 1), of(STOP, 0)]);
  assert.deepEqual(notesAndGestures(brought, false).played.commands, [of(RELEASE, 1), of(STOP, 1)]);
});

test("what is no performance is refused, soon", async () => {
  const link = new URL(await linkOf(performance(notes(20, 100)))).hash;
  const whole = inflateRawSync(Buffer.from(link.slice(6), "base64url"));
  const bombs = [
    deflateRawSync(Buffer.alloc(64 << 20)), // a short text of many bytes
    deflateRawSync(Buffer.concat([whole, Buffer.alloc(300, 0xff), Buffer.from([1])])),
    deflateRawSync(whole.subarray(0, whole.length - 1)),
    deflateRawSync(Buffer.concat([whole, Buffer.from([3, 0, 0, 0, 0])])), // it goes back in time
  ];
  for (const [number, bomb] of bombs.entries()) {
    await refuses(() => readLink(fragmentOf(bomb)), `bomb ${number}`);
  }
  await refuses(() => readLink(`#play=${"A".repeat(30_000)}`), "a long link");
  const head = JSON.stringify({ v: 1, kinds: ["toString"], addresses: [], values: {} });
  const strange = [2 * head.length, ...Buffer.from(head), 0, 0, 0, 0, 0];
  await refuses(() => readLink(fragmentOf(deflateRawSync(Buffer.from(strange)))), "a kind");
});

test("any bytes are a performance or refused", async () => {
  let seed = 1;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const link = new URL(await linkOf(performance(notes(50, 40)))).hash;
  const whole = inflateRawSync(Buffer.from(link.slice(6), "base64url"));
  for (let n = 0; n < Number(process.env.MANY ?? 200); n++) {
    const bytes = Buffer.from(whole);
    for (let m = 0; m < 1 + 4 * random(); m++) {
      bytes[Math.floor(random() * bytes.length)] = Math.floor(random() * 256);
    }
    const read = await readLink(fragmentOf(deflateRawSync(bytes))).catch(() => null);
    if (read) assert.equal(checked(read), read);
  }
});

test("as much as nobody plays is refused", async () => {
  assert.throws(() => checked(performance(notes(6000, 0))));
  assert.throws(() => checked(performance([{ ...notes(1, 0)[0], value: NaN }])));
  assert.throws(() => checked(performance([{ ...notes(1, 0)[0], frame: 1e12 }])));
  checked(performance(notes(6000, 1)));
  await refuses(() => readCapture(new Blob(["{}"])), "a file");
});

test("a link names the page that all can open, where the page was told of it", async () => {
  const told = "https://example.org/yehu/";
  globalThis.document.querySelector = () => ({ getAttribute: () => told });
  assert.ok((await linkOf(performance(notes(2, 100)))).startsWith(`${told}#play=`));
  globalThis.document.querySelector = () => null;
  assert.ok((await linkOf(performance(notes(2, 100)))).startsWith("http://a/#play="));
});

test("pages of this machine or its network are not for all", () => {
  const ours = ["127.0.0.1", "localhost", "[::1]", "192.168.0.7", "10.1.2.3", "172.20.0.1"];
  for (const host of [...ours, "studio.local", "studio", "[fd00::1]", "169.254.1.1"])
    assert.equal(isPublic(host), false, host);
  const others = ["example.org", "10.example.org", "172.32.0.1", "8.8.8.8"];
  for (const host of [...others, "[2001:db8::1]", "local.example.org"])
    assert.equal(isPublic(host), true, host);
});
