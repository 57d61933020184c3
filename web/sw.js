/**
 * Keeps the whole page for times without a network. `yehu-server page` writes which files there are,
 * and a name for all that they hold; a copy of the page that has none keeps nothing.
 *
 * Each version is kept whole, and served until no window shows it any more: versions never mix, and nothing
 * is kept that is not of this one, such as the page of a network that wants a login, or a file that is not
 * copied yet. Where nothing can be kept the page comes from the network.
 */

const VERSION = "";
/** Names, and what each holds (Subresource Integrity). @type {[string, string][]} */
const FILES = [];

const worker = /** @type {any} */ (globalThis);
const PREFIX = `yehu ${worker.registration.scope} `; // other copies of the page may share its origin
const OWN = PREFIX + VERSION;

worker.addEventListener("install", (/** @type {any} */ event) => {
  if (!VERSION) {
    worker.skipWaiting(); // a server shows this page, where another was kept before
    return;
  }
  const requests = FILES.map(
    ([file, integrity]) => new Request(file, { cache: "no-cache", integrity }),
  );
  event.waitUntil(caches.open(OWN).then((cache) => cache.addAll(requests)));
});

worker.addEventListener("activate", (/** @type {any} */ event) => {
  const forget = async () => {
    const old = (await caches.keys()).filter((key) => key.startsWith(PREFIX) && key !== OWN);
    await Promise.all(old.map((key) => caches.delete(key)));
  };
  event.waitUntil(forget());
});

worker.addEventListener("fetch", (/** @type {any} */ event) => {
  if (!VERSION || event.request.method !== "GET") return;
  const find = async () => {
    const cache = await caches.open(OWN).catch(() => null);
    const kept = await cache?.match(event.request, { ignoreSearch: true }).catch(() => null);
    return kept ?? fetch(event.request);
  };
  event.respondWith(find());
});
