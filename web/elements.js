/** Finds and makes elements of the page. */

import { onLanguage, translate } from "./i18n.js";

/** Whether a server of the instrument has sent this page. */
export const isServed = document.querySelector('meta[name="yehu-server"]') !== null;

/** @typedef {string | (() => string)} Words A function is asked again in another language. */

/**
 * The element of an id, of the class expected.
 * @template {Element} T
 * @param {string} id
 * @param {new () => T} type
 * @returns {T}
 */
export function find(id, type) {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new TypeError(`#${id} is no ${type.name}`);
  return element;
}

/**
 * Make an element. One with words of functions should stay as long as the page.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, Words | boolean | number>} [attributes] true: without value
 * @param {(Node | Words)[]} [children]
 * @returns {HTMLElementTagNameMap[K]}
 */
export function make(tag, attributes = {}, children = []) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false) continue;
    if (typeof value === "function") onLanguage(() => element.setAttribute(name, value()));
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children.map((child) => (typeof child === "function" ? words(child) : child)));
  return element;
}

/** @param {() => string} tell */
function words(tell) {
  const text = new Text();
  onLanguage(() => {
    text.data = tell();
  });
  return text;
}

/**
 * A switch, as a labelled checkbox.
 * @param {Words} text
 * @param {boolean} isOn
 * @param {(isOn: boolean) => void} changed
 */
export function makeSwitch(text, isOn, changed) {
  const box = make("input", { type: "checkbox", role: "switch" });
  box.checked = isOn;
  box.addEventListener("change", () => changed(box.checked));
  return make("label", { class: "switch" }, [box, make("span", {}, [text])]);
}

/**
 * Give a button, or withhold it with the reason in words.
 * @param {HTMLButtonElement} button
 * @param {string} [reason] why it cannot be used; none: it can
 */
export function allow(button, reason) {
  button.disabled = reason !== undefined;
  button.title = reason ?? "";
}

/**
 * Offer a file for download.
 * @param {Blob} blob
 * @param {string} name
 */
export function download(blob, name) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // long after it was read
}

/**
 * A button that is on or off, and says which.
 * @param {string} off key of its text
 * @param {string} on
 * @param {(isOn: boolean) => void | Promise<void>} changed
 */
export function toggle(off, on, changed) {
  let isOn = false;
  const button = make("button", { type: "button" });
  const tell = () => {
    button.setAttribute("aria-pressed", String(isOn));
    button.textContent = translate(isOn ? on : off);
  };
  const set = (/** @type {boolean} */ isOnNow) => {
    isOn = isOnNow;
    tell();
  };
  onLanguage(tell);
  button.addEventListener("click", () => {
    isOn = !isOn;
    tell();
    changed(isOn);
  });
  return { button, set };
}
