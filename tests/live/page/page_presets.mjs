/** Looks at which sound the page says it has, beside what its parameters are. */

import { READY, SIZES, drawn, open, pass, requested } from "./browser.mjs";

/** The presets that are shown as chosen, or as changed. @param {import("playwright-core").Page} page */
async function chosen(page) {
  if (await page.isHidden("#panel-sound")) await page.click("#tab-sound");
  await pass(page, 400); // some looks at the parameters
  const found = await page.locator("#panel-sound .cards > button").evaluateAll((cards) =>
    cards
      .map((card) => [card.ariaPressed, card.querySelector("span").textContent])
      .filter(([isPressed, name]) => isPressed === "true" || name.includes(","))
      .map(([, name]) => name),
  );
  const articulation = await page.locator(".articulation > select").inputValue();
  return [...found, articulation];
}

/** A performance in another sound, which it changes on its way; runs in the page. */
async function linkOfAnother() {
  const { default: facts } = await import("/facts.js");
  const { linkOf } = await import("/link.js");
  const { "sul-tasto": sound, hall } = facts.presets.shipped;
  const vibrato = facts.parameters.findIndex(({ address }) => address === "/playing/vibrato");
  const { BEGIN, END, WRITE } = facts.kinds;
  const commands = [
    { frame: 0, kind: BEGIN, index: 0, value: 70, other: 70 },
    { frame: 500, kind: WRITE, index: vibrato, value: 50, other: 0 },
    { frame: 3000, kind: END, index: 0, value: 70, other: 0 },
  ];
  const values = { ...sound.values, ...hall.values, "/playing/articulation": 5 };
  return linkOf({ rate: 1000, values, commands, players: 1 });
}

export default async function (browser, url) {
  const { page, errors } = await open(browser, url);
  const found = { first: await chosen(page) };
  await page.locator(".ways input[type=range]").last().fill("900");
  found.moved = await chosen(page);

  await page.click("#tab-all");
  const reset = page.locator(".reset-all");
  await reset.click();
  found.reset = [await reset.textContent(), ...(await chosen(page))];
  await page.click("#tab-all");
  await reset.click();
  found.undone = [await reset.textContent(), ...(await chosen(page))];

  await page.click("#tab-all");
  const rows = page.locator("#panel-all .parameter:not([hidden]) code");
  const all = await rows.count();
  await page.fill("#panel-all input[type=search]", "string");
  found.sought = await rows.allTextContents();
  await page.press("#panel-all input[type=search]", "Escape");
  found.escaped = [await page.inputValue("#panel-all input[type=search]"), await rows.count(), all];

  const link = await page.evaluate(linkOfAnother);
  const heard = await open(browser, link);
  found.before = await chosen(heard.page);
  await heard.page.click("#listen");
  await heard.page.waitForFunction(() => globalThis.imitation?.notes.length);
  found.during = await chosen(heard.page);
  await heard.page.waitForFunction(() => globalThis.imitation?.notes.length === 0);
  await heard.page.waitForSelector("#listen[aria-pressed=false]");
  found.after = await chosen(heard.page);
  found.sounding = await heard.page.evaluate(async () => {
    const { default: facts } = await import("/facts.js");
    const { sound, room } = { sound: "vibrato", room: "chamber" };
    const { shipped } = facts.presets;
    const values = { ...shipped[sound].values, ...shipped[room].values };
    return Object.keys(values).filter(
      (address) => Math.abs(globalThis.imitation.target(address) - values[address]) > 1e-4,
    );
  });

  if (await page.isHidden("#panel-sound")) await page.click("#tab-sound");
  for (const name of ["Sul tasto", "Hall"])
    await page.locator(".cards > button", { hasText: name }).first().click();
  await page.selectOption(".articulation > select", "3");
  await page.reload();
  await page.waitForSelector(READY);
  found.again = await chosen(page);
  await page.keyboard.press("KeyV");
  await requested(page, "BEGIN");
  found.played = await chosen(page);
  await page.setViewportSize(SIZES.phone);
  await drawn(page);
  found.phone = await page.evaluate(() => [
    [...document.querySelectorAll(".ways output")].filter((one) => one.checkVisibility()).length,
    [...document.querySelectorAll(".ways .slider > span")].filter(
      ({ scrollWidth, clientWidth }) => scrollWidth > clientWidth,
    ).length,
  ]);
  return { ...found, errors: [...errors, ...heard.errors] };
}
