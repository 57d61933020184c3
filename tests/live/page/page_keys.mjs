/** Presses a key of the computer's piano wherever the focus may be; finds where it plays nothing. */

import { commands, open } from "./browser.mjs";

const KEY = "KeyB"; // also the first letter of articulations, presets and rooms

/** What can have the focus, and so many of a kind; runs in the page. @param {number} most */
function controls(most) {
  const counts = {};
  const all = "button, select, input, textarea, summary, [tabindex]";
  for (const one of document.querySelectorAll("[data-at]")) delete one.dataset.at;
  return [...document.querySelectorAll(all)]
    .filter((one) => one.checkVisibility({ visibilityProperty: true }) && !one.disabled)
    .filter(({ tagName, type, className }) => {
      const kind = `${tagName} ${type} ${className}`;
      counts[kind] = (counts[kind] ?? 0) + 1;
      return counts[kind] <= most;
    })
    .map((one, at) => ((one.dataset.at = String(at)), one.outerHTML.slice(0, 80)));
}

/** Give one of them the focus; return its value; runs in the page. @param {number} at */
function focus(at) {
  const one = document.querySelector(`[data-at="${at}"]`);
  one.focus();
  return one.value;
}

export default async function (browser, url, { words: [most] }) {
  const { page, errors } = await open(browser, url);
  await page.click("#start");
  await page.waitForFunction(() => globalThis.imitation);
  const plays = async () => {
    await commands(page);
    await page.keyboard.press(KEY);
    return (await commands(page)).some(([kind]) => kind === "BEGIN");
  };
  const found = { count: 0, silent: [], written: [] };
  for (const tab of await page.locator("[role=tab]").all()) {
    await tab.click();
    for (const [at, text] of (await page.evaluate(controls, Number(most))).entries()) {
      found.count++;
      const before = await page.evaluate(focus, at);
      if (!(await plays())) found.silent.push(text);
      if ((await page.evaluate(focus, at)) !== before) found.written.push(text);
    }
  }
  // A field that was left by Enter or Esc gives the keys back, and a list that was chosen from.
  const search = page.locator("input[type=search]");
  found.left = [];
  for (const key of ["Enter", "Escape"]) {
    await search.fill("bow");
    await search.press(key);
    found.left.push(await plays());
  }
  const list = page.locator(".articulation select");
  await list.focus();
  await page.keyboard.press("ArrowDown");
  const chosen = await list.inputValue();
  found.chosen = [chosen, await plays(), (await list.inputValue()) === chosen];
  found.errors = errors;
  return found;
}
