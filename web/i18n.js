/**
 * The page's words, in the language chosen. What parameters and presets do is described by the server's own
 * tables (`facts.js`); other languages translate that too, under `about/...` and `preset.NAME.about`.
 */

import { remember, settings } from "./settings.js";

/** @type {Record<string, string>} */
let texts = {};

const changes = new EventTarget();

/** @returns {'en' | 'zh'} */
export function language() {
  const requested = settings.language || navigator.language;
  return requested.toLowerCase().startsWith("zh") ? "zh" : "en";
}

/** Load the words of the language. */
export async function loadWords() {
  const answer = await fetch(new URL(`texts/${language()}.json`, import.meta.url));
  texts = await answer.json();
  document.documentElement.lang = language() === "zh" ? "zh-Hans" : "en";
  document.title = translate("title");
}

/** Change the language; nothing else changes. @param {'en' | 'zh'} chosen */
export async function setLanguage(chosen) {
  remember({ language: chosen });
  await loadWords();
  fillWords();
  changes.dispatchEvent(new Event("change"));
}

/**
 * Call a function that writes words on the page, now and whenever the language has changed. For what
 * stays as long as the page.
 * @param {() => void} update
 */
export function onLanguage(update) {
  changes.addEventListener("change", update);
  update();
}

/**
 * The text of a key, with `{name}` filled in from the values.
 * @param {string} key
 * @param {Record<string, string | number>} [values]
 */
export function translate(key, values = {}) {
  return (texts[key] ?? key).replace(/\{(\w+)\}/g, (whole, name) => String(values[name] ?? whole));
}

/**
 * The text of a key, or another where there is none.
 * @param {string} key
 * @param {string} otherwise
 */
export function translateOr(key, otherwise) {
  return texts[key] ?? otherwise;
}

/**
 * Put the words into all elements that name one: `data-text` is content, `data-label` the name that
 * screen readers read.
 */
export function fillWords() {
  for (const element of document.querySelectorAll("[data-text], [data-label]")) {
    if (!(element instanceof HTMLElement)) continue;
    const { text, label } = element.dataset;
    if (text) element.textContent = translate(text);
    if (label) element.ariaLabel = translate(label);
    if (label && element instanceof HTMLButtonElement) element.title = translate(label);
  }
}
