/** Reads the documentation site: on a phone, by search and by ear; prints what it finds. */

import { readFileSync } from "node:fs";
import { SIZES, fromWeb } from "../live/page/browser.mjs";

const AXE = readFileSync(fromWeb.resolve("axe-core"), "utf8");
// The theme gives the place of each copy button the same name.
const THEMES = { rules: { "landmark-unique": { enabled: false } } };

export default async function (browser, url, { words: names }) {
  const page = await browser.newPage();
  const elsewhere = [];
  const errors = [];
  page.on("request", (request) => {
    const { protocol } = new URL(request.url());
    const isHere = request.url().startsWith(url) || ["data:", "blob:"].includes(protocol);
    if (!isHere) elsewhere.push(request.url());
  });
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  page.on("pageerror", (error) => errors.push(String(error)));

  await page.setViewportSize(SIZES.phone);
  const widths = {};
  for (const name of names) {
    await page.goto(url + name);
    widths[name] = await page.evaluate(() => document.documentElement.scrollWidth);
  }

  await page.setViewportSize(SIZES.desk);
  await page.goto(`${url}index.html`);
  const seconds = await page.evaluate(async () => {
    const sound = document.querySelector("audio");
    sound.load();
    sound.preload = "metadata";
    await new Promise((resolve) => sound.addEventListener("loadedmetadata", resolve));
    return sound.duration;
  });

  // A search that was entered before the page was ready never begins: enter it again.
  let isFound = false;
  for (let attempt = 0; attempt < 10 && !isFound; attempt++) {
    await page.evaluate(() => document.activeElement?.blur());
    await page.fill("[data-md-component=search-query]", "Helmholtz motion");
    const link = page.waitForSelector(".md-search-result__link[href*='glossary.html']", {
      state: "attached",
      timeout: 3000,
    });
    isFound = await link.then(
      () => true,
      () => false,
    );
  }
  const found = await page.$$eval(".md-search-result__link", (links) => links.map((a) => a.href));

  const barriers = [];
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    for (const name of ["index.html", "physics.html", "api/instrument.html"]) {
      await page.goto(url + name);
      await page.evaluate(AXE);
      const { violations } = await page.evaluate((options) => globalThis.axe.run(options), THEMES);
      for (const { id, nodes } of violations) {
        barriers.push({ name, colorScheme, id, html: nodes.map((node) => node.html) });
      }
    }
  }
  return { elsewhere, errors, widths, phone: SIZES.phone.width, seconds, found, barriers };
}
