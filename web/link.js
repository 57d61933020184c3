/** A performance in the fragment of a link: packed, compressed, and read again. */

/** @typedef {import('./capture.js').Performance} Performance */

import { KINDS, OF_PARAMETERS, addressOf, checked, indexOf } from "./capture.js";
import { FREE } from "./playing/table.js";

const MARK = "#play=";
const VERSION = 1;
const RATE = 1000; // frames of a link are ms
const FINE = 1e4; // values are kept to the tenth of a thousandth
const BASE = 128; // of numbers of many bytes
const MOST = 24_000; // characters that browsers and letters pass on
const MAX_BYTES = 4 << 20; // unpacked

/** Names and addresses that only this machine has, or its network: RFC 1918, 3927, 4193, 6762. */
const LOCAL =
  /^(?:[^.:]*|.*\.(?:localhost|local|lan|internal)|(?:127|10|192\.168|169\.254|172\.(?:1[6-9]|2\d|3[01]))(?:\.\d+)+|\[(?:::1|f[cd].*|fe80.*)\])$/i;

/**
 * Whether anybody can open a page of this host.
 * @param {string} host
 */
export const isPublic = (host) => !LOCAL.test(host);

/** The page that links open: the one that this page was told of (`--share-url`), or itself. */
export function sharedPage() {
  const told = document.querySelector("meta[name=yehu-share]")?.getAttribute("content");
  return told || location.origin + location.pathname + location.search;
}

/**
 * The link that plays a performance; null where it is too long for one.
 * @param {Performance} performance
 */
export async function linkOf(performance) {
  const packed = await through(new CompressionStream("deflate-raw"), pack(performance));
  const text = btoa(Array.from(packed, (byte) => String.fromCharCode(byte)).join(""));
  const safe = text.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  return safe.length > MOST ? null : sharedPage() + MARK + safe;
}

/**
 * The performance that an address brings; null where it brings none. Throws an error where it is none of
 * this instrument.
 * @param {string} fragment
 * @returns {Promise<Performance | null>}
 */
export async function readLink(fragment) {
  if (!fragment.startsWith(MARK)) return null;
  if (fragment.length > MARK.length + MOST) throw new RangeError("too long");
  const text = fragment.slice(MARK.length).replaceAll("-", "+").replaceAll("_", "/");
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return unpack(await through(new DecompressionStream("deflate-raw"), packed));
}

/**
 * @param {CompressionStream | DecompressionStream} stream
 * @param {Uint8Array<ArrayBuffer>} bytes
 */
async function through(stream, bytes) {
  const parts = [];
  let size = 0;
  // By parts: a short link may claim to be gigabytes.
  for await (const part of new Blob([bytes]).stream().pipeThrough(stream)) {
    size += part.length;
    if (size > MAX_BYTES) throw new RangeError("too large");
    parts.push(part);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/**
 * Numbers of rows and kinds differ between versions of this page: a head names those that are used.
 * @param {Performance} performance
 */
function pack({ rate, values, commands }) {
  const kinds = [...new Set(commands.map(({ kind }) => kind))];
  const addresses = [...new Set(commands.map(addressOf).filter((found) => found !== null))];
  const changed = FREE.filter((one) => (values[one.address] ?? one.default) !== one.default);
  const head = new TextEncoder().encode(
    JSON.stringify({
      v: VERSION,
      kinds: kinds.map((kind) => KINDS[kind]),
      addresses,
      values: Object.fromEntries(changed.map(({ address }) => [address, values[address]])),
    }),
  );
  /** @type {number[]} */
  const bytes = [];
  put(bytes, head.length);
  bytes.push(...head);
  /** @type {Map<string, number>} */
  const last = new Map();
  let before = 0;
  for (const command of commands) {
    const time = Math.round((command.frame / rate) * RATE);
    const address = addressOf(command);
    put(bytes, time - before);
    put(bytes, kinds.indexOf(command.kind));
    put(bytes, address === null ? command.index : addresses.indexOf(address));
    for (const name of /** @type {const} */ (["value", "other"])) {
      const value = Math.round(command[name] * FINE);
      put(bytes, value - (last.get(keyOf(command, name)) ?? 0));
      last.set(keyOf(command, name), value);
    }
    before = time;
  }
  return Uint8Array.from(bytes);
}

/**
 * @param {Uint8Array} bytes
 * @returns {Performance}
 */
function unpack(bytes) {
  let at = 0;
  const take = () => {
    let [number, weight] = [0, 1];
    for (; ; weight *= BASE) {
      if (at >= bytes.length) throw new RangeError("cut off");
      const byte = bytes[at++];
      number += (byte % BASE) * weight;
      if (!Number.isSafeInteger(number)) throw new RangeError("a number of too many bytes");
      if (byte < BASE) return number % 2 ? -(number + 1) / 2 : number / 2;
    }
  };
  const length = take();
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(at, at + length)));
  at += length;
  if (head.v !== VERSION) throw new TypeError("another version");
  const kinds = head.kinds.map((/** @type {string} */ name) => KINDS.indexOf(name));
  /** @type {Map<string, number>} */
  const last = new Map();
  const commands = [];
  for (let frame = 0; at < bytes.length;) {
    frame += take();
    const command = { frame, kind: kinds[take()], index: take(), value: 0, other: 0 };
    if (!(command.kind >= 0)) throw new TypeError("another kind");
    if (OF_PARAMETERS.includes(command.kind))
      command.index = indexOf(command.kind, head.addresses[command.index]);
    for (const name of /** @type {const} */ (["value", "other"])) {
      const value = (last.get(keyOf(command, name)) ?? 0) + take();
      last.set(keyOf(command, name), value);
      command[name] = value / FINE;
    }
    commands.push(command);
  }
  const values = FREE.map((one) => [one.address, Number(head.values[one.address] ?? one.default)]);
  return checked({ rate: RATE, values: Object.fromEntries(values), commands, players: 1 });
}

/** What a value is of: most differ little from the last one. @param {{kind: number, index: number}} command @param {string} name */
const keyOf = ({ kind, index }, name) => `${kind} ${index} ${name}`;

/**
 * Put a whole number behind others: the sign in the last bit, and seven bits a byte.
 * @param {number[]} bytes
 * @param {number} number
 */
function put(bytes, number) {
  let rest = number < 0 ? -2 * number - 1 : 2 * number;
  for (; rest >= BASE; rest = Math.floor(rest / BASE)) bytes.push((rest % BASE) + BASE);
  bytes.push(rest);
}
