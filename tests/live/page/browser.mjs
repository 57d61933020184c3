/** Opens the page in a Chromium, and does with it what a person would. */

import { createRequire } from "node:module";

/** Finds what checks the page, which `npm ci` in web/ installs. */
export const fromWeb = createRequire(new URL("../../../web/package.json", import.meta.url));
const { chromium } = fromWeb("playwright-core");

/** A name of this machine that makes no secure context. */
export const UNTRUSTED = "page.example";

const FLAGS = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  `--host-resolver-rules=MAP ${UNTRUSTED} 127.0.0.1`,
];

/** How long what is waited for may take on a busy machine, ms: 30 s ran out on one. */
export const PATIENCE = 120_000;

/** What a browser calls requests that it drops itself, such as an icon's when the page is left. */
const ABORTED = "net::ERR_ABORTED";

/** Is there once the page can be played, or never will be. */
export const READY = "#play:not([aria-busy]) #ways input";

export const SIZES = {
  phone: { width: 360, height: 740 },
  tablet: { width: 1180, height: 820 },
  desk: { width: 1440, height: 900 },
};

/**
 * A Chromium without a window.
 * @param {string} program
 * @param {string[]} flags
 * @param {Record<string, string>} environment
 */
export const launch = (program, flags = [], environment = {}) =>
  chromium.launch({
    executablePath: program,
    timeout: PATIENCE,
    args: [...FLAGS, ...flags],
    env: { ...process.env, ...environment },
  });

/**
 * A context that remembers nothing.
 * @param {import("playwright-core").Browser} browser
 */
export async function contextOf(browser) {
  const context = await browser.newContext({
    viewport: SIZES.desk,
    hasTouch: true,
    locale: "en-GB",
  });
  context.setDefaultTimeout(PATIENCE);
  return context;
}

/** Draws ten times a second instead of sixty, which would take most of a processor; runs in the page. */
export function drawSeldom() {
  globalThis.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 100);
  globalThis.cancelAnimationFrame = clearTimeout;
}

/**
 * Open the page, and collect what goes wrong on it.
 * @param {import("playwright-core").BrowserContext} browser
 * @param {string} url
 */
export async function open(browser, url) {
  const page = await browser.newPage();
  /** @type {string[]} */
  const errors = [];
  page.on("console", (message) => {
    const isWaiting =
      message.location().url.endsWith("yehu.wasm") && message.text().includes("503");
    if (["error", "warning"].includes(message.type()) && !isWaiting) errors.push(message.text());
  });
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("requestfailed", (request) => {
    const text = request.failure()?.errorText;
    if (text !== ABORTED) errors.push(`failed: ${request.url()} (${text})`);
  });
  await page.goto(url);
  await page.waitForSelector(READY);
  return { page, errors };
}

/**
 * Let time pass on the page: its own timers that end before have run, however busy the machine is.
 * @param {import("playwright-core").Page} page
 * @param {number} ms
 */
export const pass = (page, ms) =>
  page.evaluate((time) => new Promise((resolve) => setTimeout(resolve, time)), ms);

/** Stands for a browser with one MIDI keyboard; runs in the page. */
export function pretendMidi() {
  const input = { id: "one", name: "Keys", state: "connected", onmidimessage: null };
  const access = { inputs: new Map([["one", input]]), onstatechange: null };
  const pull = () => {
    input.state = "disconnected";
    access.inputs.clear(); // as Chromium has it
    access.onstatechange();
  };
  Object.assign(globalThis, { pretended: { input, pull } });
  Object.defineProperty(navigator, "requestMIDIAccess", { value: async () => access });
}

/**
 * Send a MIDI message from that keyboard.
 * @param {import("playwright-core").Page} page
 * @param {number[]} bytes
 */
export function sendMidi(page, ...bytes) {
  return page.evaluate(
    (data) => globalThis.pretended.input.onmidimessage({ data: Uint8Array.from(data) }),
    bytes,
  );
}

/** Keeps what the page makes to analyse its sound; runs in the page. */
export function keepAnalysers() {
  const Original = globalThis.AnalyserNode;
  globalThis.analysers = [];
  globalThis.AnalyserNode = class extends Original {
    constructor(...words) {
      super(...words);
      globalThis.analysers.push(this);
    }
  };
}

/**
 * Fingers on the screen, through the browser's own input.
 * @param {import("playwright-core").Page} page
 */
export async function fingersOf(page) {
  const session = await page.context().newCDPSession(page);
  /** @param {string} type @param {{x: number, y: number, id: number, force?: number}[]} touchPoints */
  const send = (type, touchPoints) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints });
  return send;
}

/**
 * The commands since the last call: [name of its kind, index, value, other, frame].
 * @param {import("playwright-core").Page} page
 */
export function commands(page) {
  return page.evaluate(async () => {
    const { default: facts } = await import("/facts.js");
    const names = Object.fromEntries(
      Object.entries(facts.kinds).map(([name, kind]) => [kind, name]),
    );
    return globalThis.imitation.commands.splice(0).map(([kind, ...rest]) => [names[kind], ...rest]);
  });
}

/**
 * Wait until commands of a kind were made, so many of them.
 * @param {import("playwright-core").Page} page
 * @param {string} kind
 * @param {number} count
 */
export async function requested(page, kind, count = 1) {
  const number = await page.evaluate(
    async (name) => (await import("/facts.js")).default.kinds[name],
    kind,
  );
  await page.waitForFunction(
    ([sought, least]) =>
      globalThis.imitation?.commands.filter(([one]) => one === sought).length >= least,
    [number, count],
  );
}

/**
 * Wait until what was resized is drawn.
 * @param {import("playwright-core").Page} page
 */
export function drawn(page) {
  return page.evaluate(
    () =>
      new Promise((resolve) =>
        requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve))),
      ),
  );
}

/**
 * The keys that are held, as far as the commands say.
 * @param {import("playwright-core").Page} page
 */
export function held(page) {
  return page.evaluate(() => globalThis.imitation?.notes.length ?? null);
}
