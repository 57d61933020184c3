// Makes the pictures of the page in docs/figures, from a page that is being shown:
//
//   scripts/yehu page --port 8010 &
//   node scripts/page_figures.mjs http://127.0.0.1:8010/ /usr/bin/chromium docs/figures

import { READY, SIZES, contextOf, launch, open } from "../tests/live/page/browser.mjs";

const [url, program, folder] = process.argv.slice(2);
const PICTURES = [
  { name: "desk", size: SIZES.desk, colorScheme: "light", view: "see", key: "KeyR" },
  { name: "tablet", size: SIZES.tablet, colorScheme: "dark", view: "sound", key: "KeyW" },
  { name: "phone", size: SIZES.phone, colorScheme: "light", view: null, key: "KeyC" },
  { name: "tune", size: SIZES.desk, colorScheme: "light", view: "tunes", key: null },
];
const SETTLED_MS = 4000;

const browser = await launch(program);
const context = await contextOf(browser);
for (const { name, size, colorScheme, view, key } of PICTURES) {
  const { page } = await open(context, url);
  await page.emulateMedia({ colorScheme });
  await page.setViewportSize(size);
  await page.evaluate(() => (localStorage.yehu = '{"isTaught":true}'));
  await page.reload();
  await page.waitForSelector(READY);
  if (view) await page.click(`#tab-${view}`);
  await page.click("#start");
  if (key) await page.keyboard.down(key);
  else await page.locator(".tune", { hasText: "Song Bie" }).locator("button").first().click();
  await page.waitForTimeout(SETTLED_MS);
  await page.evaluate(() => {
    document.activeElement.blur();
    scrollTo(0, 0);
  });
  await page.screenshot({ path: `${folder}/page_${name}.png` });
  if (key) await page.keyboard.up(key);
  await page.close();
}
await browser.close();
