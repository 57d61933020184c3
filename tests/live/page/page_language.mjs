/** Changes the page's language while it sounds; prints what was said before, after, and after loading it anew. */

import { READY, held, open, pass, pretendMidi, sendMidi } from "./browser.mjs";

/** All that the page says, by element, without the numbers that move; runs in the page. */
function said() {
  const NAMES = ["aria-label", "title", "placeholder", "label", "aria-valuetext"];
  return [...document.querySelectorAll("#page *")].map((element) => {
    const texts = [...element.childNodes].filter(({ nodeType }) => nodeType === Node.TEXT_NODE);
    const words = texts.map(({ data }) => data.trim()).filter(Boolean);
    const names = NAMES.map((name) => element.getAttribute(name));
    return [element.tagName, ...words, ...names].join("|").replace(/-?\d+(\.\d+)?/g, "#");
  });
}

export default async function (browser, url) {
  await browser.addInitScript(pretendMidi);
  const { page, errors } = await open(browser, url);
  const found = {};
  const use = async () => {
    await page.click("#tab-connect");
    await page.locator("#panel-connect button").first().click(); // use MIDI keyboards
    await page.waitForFunction(() => globalThis.imitation);
    await page.click("#tab-see");
    await page.keyboard.down("KeyC");
    await pass(page, 400);
  };
  const end = async () => {
    await page.keyboard.up("KeyC");
    await page.click("#tab-connect"); // which shows the status only while it is shown
    await pass(page, 600);
    await page.click("#tab-see");
    await pass(page, 400);
    return page.evaluate(said);
  };
  await use();
  await page.click("#tab-all");
  await page.locator("#panel-all .knob").first().click();
  await sendMidi(page, 0xb0, 20, 0);
  await sendMidi(page, 0xb0, 20, 127); // where the parameter is at first
  for (let i = 0; i < 2; i++) await page.locator("#panel-all .knob").first().click(); // says no more of it
  await page.fill("#panel-all input[type=search]", "bow");
  await page.click("#tab-see");
  await page.keyboard.up("KeyC");
  await page.keyboard.down("KeyC"); // the field has ended the note
  await pass(page, 300);
  found.before = await page.evaluate(said);

  await page.evaluate(() => (globalThis.stays = true));
  await page.click("#language");
  await page.waitForFunction(() => document.title === "椰胡");
  found.stays = await page.evaluate(() => globalThis.stays ?? false);
  found.held = await held(page);
  found.searched = await page.inputValue("#panel-all input[type=search]");
  found.after = await end();

  await page.reload();
  await page.waitForSelector(READY);
  await use();
  found.anew = await end();
  found.errors = errors;
  return found;
}
