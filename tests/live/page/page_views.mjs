/** Checks the page in every size, theme and language; prints what it finds. */

import {
  READY,
  SIZES,
  commands,
  drawn,
  held,
  open,
  pass,
  pretendMidi,
  requested,
} from "./browser.mjs";

/** Elements that a finger should be able to touch, and their sizes. */
const TARGETS = "button:not([hidden]), select, input, summary, canvas[tabindex]";

export default async function (browser, url) {
  await browser.addInitScript(pretendMidi);
  /** @type {Record<string, any>} */
  const found = { layouts: {}, errors: [] };
  const { page, errors } = await open(browser, url);
  for (const [size, viewport] of Object.entries(SIZES)) {
    await page.setViewportSize(viewport);
    await drawn(page);
    const layout = {};
    for (const panel of ["see", "sound", "tunes", "keep", "connect", "all"]) {
      await page.click(`#tab-${panel}`);
      layout[panel] = await page.evaluate((targets) => {
        const small = [...document.querySelectorAll(targets)]
          .filter((element) => {
            if (!element.checkVisibility()) return false;
            // A label's whole room is its control's.
            const { width, height } = (element.closest("label") ?? element).getBoundingClientRect();
            return Math.min(width, height) < 43.5;
          })
          .map((element) => element.outerHTML.slice(0, 120));
        const nameless = [...document.querySelectorAll("button, select, input, canvas")]
          .filter(
            (element) =>
              element.checkVisibility() &&
              !element.textContent.trim() &&
              !element.getAttribute("aria-label") &&
              !element.closest("label"),
          )
          .map((element) => element.outerHTML.slice(0, 120));
        return { wide: document.documentElement.scrollWidth - innerWidth, small, nameless };
      }, TARGETS);
    }
    const bottom = async (id) => {
      const box = await page.locator(id).boundingBox();
      return box.y + box.height;
    };
    found.layouts[size] = {
      panels: layout,
      height: viewport.height,
      hands: Math.max(await bottom("#fingerboard"), await bottom("#bow")),
    };
  }

  // A panel beside the instrument, on a laptop.
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.click("#tab-sound");
  await drawn(page);
  found.beside = {
    more: await page.isVisible("#more"),
    shift: await page.isVisible("#higher"),
  };

  await page.setViewportSize(SIZES.desk);
  await page.reload();
  await page.waitForSelector(READY);
  // The way through the page by the tab key, from its beginning to the tabs.
  found.focus = [];
  for (let i = 0; i < 14; i++) {
    await page.keyboard.press("Tab");
    found.focus.push(
      await page.evaluate(() => {
        const { id, type, textContent, ariaLabel } = document.activeElement;
        const ring = getComputedStyle(document.activeElement).outlineStyle;
        return { id, name: ariaLabel ?? (textContent.trim() || type), ring };
      }),
    );
  }
  await page.click("#start");
  await page.waitForFunction(() => globalThis.imitation);
  await page.waitForSelector("#status[data-state=on]", { state: "attached" });
  found.status = [];
  for (const loadPercent of [3, 85]) {
    await page.evaluate((load) => (globalThis.imitation.status.loadPercent = load), loadPercent);
    await pass(page, 600);
    found.status.push(await page.textContent("#status"));
  }

  // The bow, placed by the diagram.
  await page.click("#tab-see");
  await commands(page);
  const diagram = await page.locator("#schelleng").boundingBox();
  await page.mouse.move(diagram.x + diagram.width * 0.3, diagram.y + diagram.height * 0.7);
  await page.mouse.down();
  await page.mouse.move(diagram.x + diagram.width * 0.8, diagram.y + diagram.height * 0.2);
  await page.mouse.up();
  found.placed = await commands(page);
  // Its upper right corner, 6 px from the edge, of one that is not drawn yet.
  found.corner = await page.evaluate(async () => {
    const { Schelleng } = await import("/pictures/schelleng.js");
    const canvas = document.createElement("canvas");
    canvas.style.cssText = "position: fixed; width: 400px; height: 300px";
    document.body.append(canvas);
    const { beta, force } = new Schelleng(canvas).pointAt(394, 0);
    canvas.remove();
    return [beta, force];
  });

  await page.click("#tab-sound");
  await commands(page);
  await page.click("#panel-sound .cards button:nth-child(3)");
  found.preset = await commands(page);

  // The tuner measures from the notes of the tuning: this one's A is 43 cents flat.
  const tunings = page.locator("#panel-sound section", { hasText: "Tuning" }).locator("select");
  await tunings.selectOption("chaozhou-seven-equal");
  await page.click("#tab-see");
  await page.keyboard.down("KeyZ");
  await page.waitForFunction(() => /cents/.test(document.querySelector("#tuner").ariaLabel));
  found.tuner = await page.getAttribute("#tuner", "aria-label");
  await page.keyboard.up("KeyZ");
  await page.click("#tab-sound");
  await tunings.selectOption("equal");
  await commands(page);

  await page.click("#tab-all");
  await page.fill("#panel-all input[type=search]", "bow speed");
  found.search = await page.evaluate(() =>
    [...document.querySelectorAll("#panel-all .parameter:not([hidden]) code")].map(
      (code) => code.textContent,
    ),
  );
  await page.fill("#panel-all input[type=search]", "/playing/attack");
  const number = page.locator("#panel-all .parameter:not([hidden]) input[type=number]");
  await number.fill("9999");
  await number.press("Enter");
  found.clamped = { shown: await number.inputValue(), commands: await commands(page) };
  await page.click("#panel-all .parameter:not([hidden]) .reset");
  found.reset = { shown: await number.inputValue(), commands: await commands(page) };

  await page.click("#tab-tunes");
  await page.locator("#panel-tunes button").first().click();
  await requested(page, "BEGIN");
  found.tune = (await commands(page)).filter(([kind]) => kind === "BEGIN").length;
  await page.locator("#panel-tunes button").first().click();
  found.tuneStopped = { held: await held(page), commands: await commands(page) };
  await commands(page);

  // What is kept and loaded again asks for the same.
  await page.click("#tab-keep");
  const keep = page.getByRole("button", { name: "Keep", exact: true });
  await keep.click();
  await page.keyboard.press("KeyX");
  await page.keyboard.press("KeyC");
  found.played = await commands(page);
  const download = page.waitForEvent("download");
  await page.locator("#panel-keep button[aria-pressed=true]").click();
  await page.getByRole("button", { name: "Save as a file" }).click();
  const file = await (await download).path();
  found.kept = (await import("node:fs")).readFileSync(file, "utf8").trim().split("\n").slice(1);
  await commands(page);
  await page.locator("#panel-keep input[type=file]").setInputFiles(file);
  await requested(page, "END", 2);
  found.replayed = await commands(page);
  await page.locator("#panel-keep input[type=file]").setInputFiles({
    name: "wrong.jsonl",
    mimeType: "text/plain",
    buffer: Buffer.from('{"format":1}\n[1]'),
  });
  const word = page.locator("#panel-keep section:nth-child(1) p[role=status]");
  await word.getByText("wrong.jsonl").waitFor();
  found.wrong = await word.textContent();

  // A keyboard that is plugged in, plays, and is pulled out while a key is down.
  await page.click("#tab-connect");
  await page.getByRole("button", { name: "Use MIDI keyboards" }).click();
  await page.waitForSelector("#panel-connect select:not([hidden])");
  await commands(page);
  await page.evaluate(() => {
    const { input } = globalThis.pretended;
    input.onmidimessage({ data: Uint8Array.of(0x90, 70, 100) });
    globalThis.pretended.pull();
  });
  found.midi = await commands(page);
  found.inputs = await page.locator("#panel-connect section:first-child option").allTextContents();

  // A tune that waits for its notes.
  await page.click("#tab-tunes");
  const tune = page.locator("#panel-tunes .tune", { hasText: "Shi Bei Jiu" });
  found.listening = await tune.locator("button").first().getAttribute("aria-label");
  await tune.locator("button").nth(1).click();
  const bar = tune.locator("progress");
  found.along = [await bar.evaluate((element) => element.value)];
  const first = await page.evaluate(async () => {
    const { default: examples } = await import("/examples.js");
    return examples.shi_bei_jiu.events.find(([, [status]]) => (status & 0xf0) === 0x90)[1][1];
  });
  await page.keyboard.press(first === 65 ? "KeyX" : "KeyZ"); // a wrong one
  found.along.push(await bar.evaluate((element) => element.value));
  await page.evaluate((pitch) => {
    globalThis.imitation.commands.length = 0;
    const keys = ["Z", "S", "X", "D", "C", "F", "V", "B", "H", "N", "J", "M"];
    const code = `Key${keys[pitch - 65]}`;
    for (const type of ["keydown", "keyup"])
      window.dispatchEvent(new KeyboardEvent(type, { code }));
  }, first);
  found.along.push(await bar.evaluate((element) => element.value));
  found.stopping = await tune.locator("button").nth(1).getAttribute("aria-label");
  await page.keyboard.press("Escape");
  found.alongEnded = (await bar.isHidden()) && (await page.locator("#lesson").isHidden());

  await page.click("#theme");
  found.theme = await page.evaluate(() => document.documentElement.dataset.theme);
  await page.click("#language");
  await page.waitForFunction(() => document.title === "椰胡");
  await page.waitForSelector(READY);
  found.language = await page.evaluate(() => ({
    lang: document.documentElement.lang,
    start: document.querySelector("#start").textContent,
    theme: document.documentElement.dataset.theme,
    bare: [...document.querySelectorAll("[data-text]")]
      .filter((e) => e.textContent === e.dataset.text)
      .map((e) => e.dataset.text),
  }));
  found.errors.push(...errors);
  return found;
}
