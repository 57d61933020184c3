/** Checks what keeps people out, by axe-core, in each view; prints what it finds.
 * With the word "all" on a phone and a desk both dark and light, otherwise on a light phone. */

import { readFileSync } from "node:fs";
import { SIZES, fromWeb, open } from "./browser.mjs";

const AXE = readFileSync(fromWeb.resolve("axe-core"), "utf8");
const VIEWS = ["see", "sound", "tunes", "keep", "connect", "all"];

/** Lets the page remember something that was taught; runs in the page. */
function teach() {
  const keyboard = [{ source: "cc 74", target: "/playing/vibrato" }];
  localStorage.yehu ??= JSON.stringify({ learned: { keyboard } });
}

const BOTH = ["light", "dark"];
const SCHEMES = {
  all: { phone: BOTH, desk: BOTH },
  some: { phone: ["light"], desk: [] },
};

export default async function (browser, url, { words: [which] }) {
  await browser.addInitScript(teach);
  const found = [];
  for (const size of /** @type {const} */ (["phone", "desk"])) {
    const viewport = SIZES[size];
    for (const colorScheme of SCHEMES[which][size]) {
      const { page } = await open(browser, url);
      await page.emulateMedia({ colorScheme });
      await page.setViewportSize(viewport);
      await page.evaluate(AXE); // past the page's policy, which allows its own scripts only
      for (const view of VIEWS) {
        await page.click(`#tab-${view}`);
        // What is beside the panel is the same in each view.
        const part = view === VIEWS[0] ? "html" : "#more";
        const { violations } = await page.evaluate((one) => globalThis.axe.run(one), part);
        for (const { id, impact, nodes } of violations) {
          found.push({ view, colorScheme, width: viewport.width, id, impact, html: nodes[0].html });
        }
      }
      await page.close();
    }
  }
  return found;
}
