/** The service worker, in a browser that is none: what it keeps, and what it answers. */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInNewContext } from "node:vm";

const ORIGIN = "http://a";
const empty = readFileSync(`${process.env.WEB ?? "web"}/sw.js`, "utf8");
const text = empty
  .replace('VERSION = ""', 'VERSION = "1"')
  .replace("FILES = []", 'FILES = [["./", "sha256-x"]]');

function started(open, { code = text, caches = {}, skipWaiting = undefined } = {}) {
  const listeners = {};
  const requests = [];
  runInNewContext(code, {
    addEventListener: (name, listener) => (listeners[name] = listener),
    caches: { open, ...caches },
    registration: { scope: `${ORIGIN}/yehu/` },
    skipWaiting,
    fetch: async (request) => `from the network: ${request.url}`,
    Request: class {
      constructor(url, options) {
        requests.push({ url, ...options });
      }
    },
  });
  return { listeners, requests };
}

async function answer({ listeners }, url) {
  let found;
  listeners.fetch({
    request: { method: "GET", url },
    respondWith: (given) => (found = given),
  });
  return found;
}

test("only files of this version are kept", async () => {
  const { listeners, requests } = started(async () => ({
    addAll: async () => {},
  }));
  listeners.install({ waitUntil: () => {} });
  assert.deepEqual(requests, [{ url: "./", cache: "no-cache", integrity: "sha256-x" }]);
});

test("where nothing can be kept or found all comes from the network", async () => {
  const fails = async () => {
    throw new Error("denied");
  };
  for (const open of [
    fails,
    async () => ({ match: fails }),
    async () => ({ match: async () => {} }),
  ])
    assert.equal(await answer(started(open), `${ORIGIN}/x`), `from the network: ${ORIGIN}/x`);
  const kept = started(async () => ({ match: async () => "kept" }));
  assert.equal(await answer(kept, `${ORIGIN}/x`), "kept");
});

test("a new version forgets older ones of its own folder, and no other page's", async () => {
  const names = [];
  const opened = async (name) => void names.push(name) ?? { addAll: async () => {} };
  started(opened).listeners.install({ waitUntil: () => {} });
  const [own] = names;
  const other = own.replace("/yehu/", "/yehu/beside/");
  const keys = [own, own.replace(/1$/, "0"), other, other.replace(/1$/, "0"), "theirs"];
  const deleted = [];
  const caches = {
    keys: async () => keys,
    delete: async (key) => deleted.push(key),
  };
  let done;
  started(opened, { caches }).listeners.activate({
    waitUntil: (given) => (done = given),
  });
  await done;
  assert.deepEqual(deleted, [keys[1]]);
});

test("a page that a server shows takes the place of one that was kept", () => {
  let skipped = 0;
  const { listeners } = started(undefined, {
    code: empty,
    skipWaiting: () => (skipped += 1),
  });
  listeners.install({});
  assert.equal(skipped, 1);
});
