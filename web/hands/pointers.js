/** Follows fingers, pens and the mouse on one element, so that each that comes also goes. */

/**
 * @typedef {object} Touch One finger, pen or mouse that is down.
 * @property {number} id
 * @property {number} x px from the left of the element
 * @property {number} y px from its top
 * @property {number | null} pressure 0 to 1; null where the device has none
 * @property {number} time ms
 *
 * @typedef {object} Followers
 * @property {(touch: Touch) => void} down
 * @property {(touches: Touch[]) => void} move the way since the last call, in order; one finger's
 * @property {(id: number, kind: string) => void} up with the kind of its pointer
 */

/** Pressures that devices without a sensor report. */
const NO_PRESSURE = new Set([0, 0.5, 1]);

/** Do something whenever the page is left: events of what is let go then never arrive. @param {() => void} action */
export function onLeave(action) {
  for (const left of ["blur", "pagehide"]) window.addEventListener(left, action);
  document.addEventListener("visibilitychange", () => document.hidden && action());
}

export class Pointers {
  /** @param {HTMLElement} element @param {Followers} followers */
  constructor(element, followers) {
    this.element = element;
    this.followers = followers;
    /** @type {Map<number, string>} their kinds, by id */
    this.down = new Map();
    this.hasPressure = false;
    const end = (/** @type {PointerEvent} */ event) => this.#end(event.pointerId);
    element.addEventListener("pointerdown", (event) => this.#begin(event));
    element.addEventListener("pointermove", (event) => this.#move(event));
    element.addEventListener("pointerup", end);
    element.addEventListener("pointercancel", end);
    element.addEventListener("lostpointercapture", end);
    for (const left of ["blur", "keydown"]) {
      element.addEventListener(left, () => delete element.dataset.touched);
    }
    element.addEventListener("contextmenu", (event) => event.preventDefault());
    onLeave(() => this.endAll());
  }

  /** Lift all that are down. */
  endAll() {
    for (const id of [...this.down.keys()]) this.#end(id);
  }

  /** @param {PointerEvent} event */
  #begin(event) {
    if (event.pointerType === "mouse" && event.button !== 0) return;
    event.preventDefault();
    this.element.dataset.touched = ""; // focus by touch needs no ring
    this.element.focus({ preventScroll: true });
    // A first finger means that no other touches the screen, whatever was heard of their lifting.
    if (event.isPrimary && event.pointerType === "touch") {
      for (const [id, kind] of [...this.down]) if (kind === "touch") this.#end(id);
    }
    this.#end(event.pointerId);
    this.down.set(event.pointerId, event.pointerType);
    try {
      this.element.setPointerCapture(event.pointerId);
    } catch {
      // Gone already: its end is on its way.
    }
    this.followers.down(this.#touch(event));
  }

  /** @param {PointerEvent} event */
  #move(event) {
    if (!this.down.has(event.pointerId)) return;
    if (event.pointerType === "mouse" && event.buttons === 0) {
      this.#end(event.pointerId); // released without an event
      return;
    }
    const events = event.getCoalescedEvents?.() ?? [];
    this.followers.move((events.length ? events : [event]).map((one) => this.#touch(one)));
  }

  /** @param {number} id */
  #end(id) {
    const kind = this.down.get(id);
    if (kind === undefined) return;
    this.down.delete(id);
    if (this.element.hasPointerCapture(id)) this.element.releasePointerCapture(id);
    this.followers.up(id, kind);
  }

  /**
   * @param {PointerEvent} event
   * @returns {Touch}
   */
  #touch(event) {
    const box = this.element.getBoundingClientRect();
    const isPen = event.pointerType === "pen";
    this.hasPressure ||= event.pointerType === "touch" && !NO_PRESSURE.has(event.pressure);
    return {
      id: event.pointerId,
      x: event.clientX - box.left,
      y: event.clientY - box.top,
      pressure:
        isPen || (this.hasPressure && event.pointerType === "touch") ? event.pressure : null,
      time: event.timeStamp,
    };
  }
}
