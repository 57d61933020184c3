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
  element.append(...children.map((child) => (typeof child === "function" ? live(child) : child)));
  return element;
}

/** @param {() => string} read */
function live(read) {
  const text = new Text();
  onLanguage(() => {
    text.data = read();
  });
  return text;
}

/**
 * The words of a key, in any language.
 * @param {string} key
 * @returns {() => string}
 */
export const words = (key) => () => translate(key);

/** A quiet line of text. @param {Words} text */
export const note = (text) => make("p", { class: "soft" }, [text]);

/**
 * A part of a panel.
 * @param {string} key of its title
 * @param {(Node | Words)[]} children
 */
export function section(key, ...children) {
  return make("section", { class: "group" }, [make("h2", {}, [words(key)]), ...children]);
}

/**
 * @param {Words} text
 * @param {() => unknown} action
 * @param {Record<string, Words | boolean | number>} [attributes]
 */
export function makeButton(text, action, attributes = {}) {
  const button = make("button", { type: "button", ...attributes }, [text]);
  button.addEventListener("click", action);
  return button;
}

/**
 * Buttons of which one is pressed.
 * @template {string} T
 * @param {Words} label of all
 * @param {readonly T[]} names
 * @param {string} prefix of the keys of their words, and of their ids
 * @param {(name: T) => void} choose
 */
export function makeChoice(label, names, prefix, choose) {
  const buttons = names.map((name) =>
    makeButton(words(`${prefix}.${name}`), () => choose(name), { id: `${prefix}-${name}` }),
  );
  const show = (/** @type {string} */ chosen) =>
    buttons.forEach((button, i) =>
      button.setAttribute("aria-pressed", String(names[i] === chosen)),
    );
  const element = make("div", { class: "choice", role: "group", "aria-label": label }, buttons);
  return { element, buttons, show };
}

/**
 * A list to choose from.
 * @param {Words} label
 * @param {Node[]} options
 * @param {(value: string) => void} choose
 */
export function makeSelect(label, options, choose) {
  const select = make("select", { "aria-label": label }, options);
  select.addEventListener("change", () => choose(select.value));
  return select;
}

/**
 * A switch, as a labelled checkbox.
 * @param {Words} text
 * @param {boolean} isOn
 * @param {(isOn: boolean) => void} changed
 * @param {Words} [title]
 */
export function makeSwitch(text, isOn, changed, title = "") {
  const box = make("input", { type: "checkbox", role: "switch" });
  box.checked = isOn;
  box.addEventListener("change", () => changed(box.checked));
  return make("label", { class: "switch", title }, [box, make("span", {}, [text])]);
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
 * @param {(isOn: boolean) => void | Promise<void>} change called once it is done with the change before;
 *   `isOn` shows presses meanwhile
 * @param {Record<string, string>} [values] of its texts
 */
export function toggle(off, on, change, values = {}) {
  let isOn = false;
  let isDone = false; // what was called for last
  let isBusy = false;
  const show = () => {
    button.setAttribute("aria-pressed", String(isOn));
    button.textContent = translate(isOn ? on : off, values);
  };
  /** @param {boolean} isOnNow without a call */
  const set = (isOnNow) => {
    isOn = isDone = isOnNow;
    show();
  };
  const press = async () => {
    isOn = !isOn;
    show();
    if (isBusy) return;
    isBusy = true;
    try {
      while (isDone !== isOn) await change((isDone = isOn));
    } finally {
      isBusy = false;
    }
  };
  const button = makeButton("", press);
  onLanguage(show);
  return {
    button,
    set,
    press,
    get isOn() {
      return isOn;
    },
  };
}

/**
 * Do something now and again, while an element is shown.
 * @param {HTMLElement} element
 * @param {() => void} action
 * @param {number} [every] ms
 */
export function whileShown(element, action, every = 250) {
  setInterval(() => {
    if (element.checkVisibility() && !document.hidden) action();
  }, every);
}
