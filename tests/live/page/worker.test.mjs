/** The service worker, in a browser that is none: what it keeps, and what it answers. */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInNewContext } from "node:vm";

const ORIGIN = "http://a";
const text = readFileSync(`${process.env.WEB ?? "web"}/sw.js`, "utf8")
  .replace('VERSION = ""', 'VERSION = "1"')
  .replace("FILES = []", 'FILES = [["./", "sha256-x"]]');

function started(open) {
  const listeners = {};
  const requests = [];
  runInNewContext(text, {
    addEventListener: (name, listener) => (listeners[name] = listener),
    caches: { open },
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
  listeners.fetch({ request: { method: "GET", url }, respondWith: (given) => (found = given) });
  return found;
}

test("only files of this version are kept", async () => {
  const { listeners, requests } = started(async () => ({ addAll: async () => {} }));
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
