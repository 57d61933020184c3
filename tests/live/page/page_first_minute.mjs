/** Plays the first minute: an invitation, three gestures; keeps a performance as a link, and opens it. */

import { commands, drawn, fingersOf, held, open, pass, requested } from "./browser.mjs";

const SIZES = [
  [1920, 1080],
  [820, 1180],
  [390, 844],
  [320, 568],
  [844, 390],
];

/** What is shown, but not whole on the screen; runs in the page. */
function cut() {
  const isCut = ({ left, top, right, bottom }) =>
    left < -1 || top < -1 || right > innerWidth + 1 || bottom > innerHeight + 1;
  return [...document.querySelectorAll("#page > *, #page header *, #play *")]
    .filter((element) => element.checkVisibility() && !element.closest("svg"))
    .filter((element) => element.getClientRects().length && isCut(element.getBoundingClientRect()))
    .map((element) => element.outerHTML.slice(0, 100));
}

/** Signs of the notes' names, upright, that touch that of another note; runs in the page. */
async function touching() {
  const { writeNotes } = await import("/pictures/wood.js");
  const semitone = 22; // px, as on a phone
  const context = document.createElement("canvas").getContext("2d");
  const signs = [];
  let note = 0;
  const write = (text, along, across) => {
    if (across !== 16) return;
    const { actualBoundingBoxAscent: up, actualBoundingBoxDescent: down } =
      context.measureText(text);
    if (text !== "·") note++; // its dots follow
    signs.push({ text, note, top: along - up, bottom: along + down });
  };
  const scale = {
    length: 26 * semitone,
    placeOf: (pitch) => semitone * (pitch - 64),
    pitchAt: (place) => place / semitone + 64,
  };
  const surface = { board: [0, scale.length], breadth: 300, isUpright: true };
  writeNotes({ context, surface, colours: {}, fingerboard: { scale }, keys: new Map(), write });
  signs.sort((one, other) => one.top - other.top);
  const close = signs.filter(
    ({ note: own, top }, i) => own !== signs[i - 1]?.note && top < signs[i - 1]?.bottom + 0.5,
  );
  return { count: signs.length, close: close.map(({ text }) => text) };
}

export default async function (browser, url) {
  const { page, errors } = await open(browser, url);
  const found = { cut: {}, said: [] };
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    await drawn(page);
    found.cut[`${width}x${height}`] = await page.evaluate(cut);
    found.upright ??= {};
    found.upright[`${width}x${height}`] = await page.locator("#stage.down").count();
  }
  await page.setViewportSize({ width: 1440, height: 900 });
  found.touching = await page.evaluate(touching);
  const touch = await fingersOf(page);
  const words = () => page.locator("#guide:not([hidden]) p[role=status]").allTextContents();
  found.invited = await page.locator("#invite").isVisible();
  const board = await page.locator("#fingerboard").boundingBox();
  const bow = await page.locator("#bow").boundingBox();
  const finger = (along, id = 1) => ({
    x: board.x + board.width * along,
    y: board.y + board.height * 0.4,
    id,
  });

  await touch("touchStart", [finger(0.3)]);
  await page.waitForFunction(() => globalThis.imitation);
  found.invitedStill = await page.locator("#invite").isVisible();
  found.said.push(await words());
  for (let step = 1; step <= 10; step++) await touch("touchMove", [finger(0.3 + step * 0.01)]);
  found.said.push(await words());
  // Six times a second, however slow this machine is; until it is noticed.
  const [before] = await words();
  const began = Date.now();
  const elapsed = () => (Date.now() - began) / 1000;
  while (elapsed() < 1 || (elapsed() < 10 && (await words())[0] === before)) {
    await touch("touchMove", [finger(0.4 + 0.006 * Math.sin(2 * Math.PI * 6 * elapsed()))]);
    await pass(page, 20);
  }
  found.rocked = await commands(page);
  await touch("touchEnd", []);
  found.said.push(await words());
  for (const along of [0.5, 0.4, 0.6, 0.3]) {
    // Firmer or lighter, until it is in the green.
    const at = (share) => ({ x: bow.x + bow.width * along, y: bow.y + bow.height * share, id: 2 });
    await touch("touchStart", [at(0.2)]);
    for (let step = 0; step < 40; step++) {
      await touch("touchMove", [at(0.2 + 0.015 * step)]);
      await pass(page, 20);
    }
    await touch("touchEnd", []);
    if (await page.locator("#guide .live").isVisible()) break;
  }
  found.said.push(await words());
  found.taught = await page.evaluate(() => JSON.parse(localStorage.yehu).isTaught);
  await touch("touchStart", [{ x: bow.x + bow.width * 0.98, y: bow.y + 40, id: 2 }]);
  const tone = page.locator("#guide");
  for (let step = 0; step < 400 && found.pressed !== "scratch"; step++) {
    // Down and up again: it says "scratch" as soon as it has heard the bow.
    const down = 240 * Math.abs(((step / 20 + 1) % 2) - 1);
    await touch("touchMove", [{ x: bow.x + bow.width * 0.98, y: bow.y + 40 + down, id: 2 }]);
    await pass(page, 20);
    found.pressed = await tone.getAttribute("data-tone");
  }
  await touch("touchEnd", []);
  await page.click("#skip");
  await page.keyboard.press("?");
  found.helped = await words();
  await page.keyboard.press("?");
  found.put = await words();

  await page.click("#tab-keep");
  await page.getByRole("button", { name: "Keep", exact: true }).click();
  await commands(page);
  await page.keyboard.press("KeyX", { delay: 200 });
  await touch("touchStart", [finger(0.5)]);
  for (let step = 1; step <= 10; step++) await touch("touchMove", [finger(0.5 + step * 0.01)]);
  await pass(page, 1500); // a busy machine has to catch the note while it sounds, below
  await touch("touchEnd", []);
  await pass(page, 100);
  found.played = await commands(page);
  await page.getByRole("button", { name: "Record", exact: true }).click();
  const on = page.locator("#panel-keep .row:has([aria-pressed=true])");
  await on.getByText(/0:0/).nth(1).waitFor();
  found.keeping = await on.allInnerTexts();
  await page.getByRole("button", { name: "Stop recording" }).click();
  await page.getByRole("button", { name: "Stop keeping" }).click();
  const link = await page.getByLabel("Link that plays it").inputValue();
  await page.evaluate(() => localStorage.clear());
  await page.close();

  // A newcomer who opens the link hears the tune first, by either button; again; and is then taught.
  const { page: friend, errors: others } = await open(browser, link);
  const listen = friend.locator("#listen");
  const guided = () => friend.locator("#guide").isVisible();
  found.link = {
    length: link.length,
    offered: [await listen.textContent()],
    guided: [await guided()],
  };
  await friend.click("#start");
  await friend.waitForFunction(() => globalThis.imitation);
  await requested(friend, "END", found.played.filter(([kind]) => kind === "END").length);
  found.link.offered.push(await listen.textContent());
  await listen.getByText("Listen").waitFor();
  found.replayed = await commands(friend);
  found.heldAfter = await held(friend);
  await friend.keyboard.press("KeyX");
  found.link.guided.push(await guided());
  await commands(friend);
  await listen.click();
  await requested(friend, "BEGIN");
  await listen.click();
  found.link.offered.push(await listen.textContent());
  found.link.heldAfterStop = await held(friend);
  await friend.locator("#brought").getByText("Close").click();
  await friend.waitForSelector("#guide:not([hidden])");
  found.link.offered.push(await listen.isVisible());
  await friend.close();

  // What a link would hold is left out, and that is said where its reader looks.
  const holding = await open(browser, link);
  const other = await holding.page.evaluate(async () => {
    const { linkOf, readLink } = await import("/link.js");
    const { default: facts } = await import("/facts.js");
    const brought = await readLink(location.hash);
    const index = facts.parameters.findIndex(({ address }) => address === "/playing/vibrato");
    const hold = { frame: 0, kind: facts.kinds.HOLD, index, value: 20, other: 0 };
    return linkOf({ ...brought, commands: [hold, ...brought.commands] });
  });
  await holding.page.close();
  const { page: reader } = await open(browser, other);
  await reader.click("#listen");
  const notice = reader.locator("#brought p").getByText("settings");
  await notice.waitFor();
  found.leftOut = await notice.textContent();
  await reader.close();

  // Somebody who touches the string while it plays goes on from there.
  const { page: third } = await open(browser, link);
  const hand = await fingersOf(third);
  await third.click("#listen");
  await third.waitForFunction(() => globalThis.imitation?.notes.length === 1, undefined, {
    polling: 10,
  });
  const { x, y, width, height } = await third.locator("#fingerboard").boundingBox();
  await hand("touchStart", [{ x: x + 0.8 * width, y: y + height / 2, id: 1 }]);
  await pass(third, 2500); // longer than what was kept
  found.taken = { held: await held(third), commands: await commands(third) };
  found.taken.offered = await third.locator("#listen").textContent();
  await hand("touchEnd", []);
  await pass(third, 100);
  found.let = await held(third);
  found.errors = [...errors, ...others];
  return found;
}
