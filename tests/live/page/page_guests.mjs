/** Opens the page of a server as a guest: without a PIN, and with one. */

import { open } from "./browser.mjs";

const NO_PIN = 4401;

export default async function (browser, url) {
  const found = { asked: [] };
  await browser.routeWebSocket(/socket/, (socket) => {
    found.asked.push(new URL(socket.url()).search);
    if (!socket.url().includes("pin=123456")) socket.close({ code: NO_PIN, reason: "no" });
    else socket.send(JSON.stringify({ status: { role: "play", parts: 1, sounds: "ready" } }));
  });
  const { page, errors } = await open(browser, url);
  const form = page.locator("#panel-connect form");
  await form.waitFor();
  found.question = await form.textContent();
  await form.locator("input").fill(" 123456 ");
  await Promise.all([page.waitForURL(/pin=123456/), form.locator("button").click()]);
  await page.waitForSelector('html[data-role="play"]', { state: "attached" });
  await page.click("#tab-sound");
  found.cards = await page.locator("#panel-sound .cards").first().isVisible();
  await page.click("#tab-all");
  found.reset = await page.locator(".reset-all").isVisible();
  await page.click("#tab-connect");
  found.status = await page.locator("#panel-connect").textContent();
  found.formIsShown = await page.locator("#panel-connect form").isVisible();
  found.errors = errors;
  return found;
}
