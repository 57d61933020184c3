/** A canvas that is drawn 60 times a second while somebody can see it, and otherwise not at all. */

/** @typedef {import('../interfaces.js').Snapshot} Snapshot */

/**
 * @typedef {object} Moment What a picture is drawn from.
 * @property {Snapshot | null} state null before the start
 * @property {boolean} isNew the state is another than at the last moment
 * @property {boolean} isTouched a hand has changed something
 * @property {number} now s
 * @property {number} elapsed s since it was drawn last; 0 at first
 * @property {boolean} isCalm whoever watches wants as little motion as possible
 *
 * @typedef {Record<Colour, string>} Colours
 * @typedef {'ink' | 'soft' | 'faint' | 'line' | 'paper' | 'surface' | 'inner' | 'outer' | 'accent'
 *   | 'good' | 'bad' | 'glow' | 'wood' | 'edge' | 'shell' | 'lid' | 'hair'} Colour
 */

/** Custom properties of the style sheet. */
const COLOURS = /** @type {Colour[]} */ (
  "ink soft faint line paper surface inner outer accent good bad glow wood edge shell lid hair".split(
    " ",
  )
);
/** Whoever wants little motion sees a picture anew so often only, s; and at once what a hand has changed. */
const CALM = 0.4;
const RESTS_AFTER = 300; // ms without news
const LONGEST = 0.5; // s that a picture goes on by at once
const MAX_DOTS = 3; // per px: finer is not seen, and costs
/** A large picture is drawn as one of this size, magnified: it is read from the last row. */
const LARGE = { width: 640, height: 400, most: 3 };

/** @type {Colours | null} */
let colours = null;

/** Read the colours of the present theme. */
function readColours() {
  const style = getComputedStyle(document.documentElement);
  const found = COLOURS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]);
  colours = /** @type {Colours} */ (Object.fromEntries(found));
  return colours;
}

/**
 * The font of the page, for text in a picture.
 * @param {number} size px
 * @param {number} [weight]
 */
export function font(size, weight = 400) {
  return `${weight} ${size}px system-ui, -apple-system, "Noto Sans", "PingFang SC", sans-serif`;
}

/** @typedef {CanvasRenderingContext2D} Context */
/** @typedef {readonly [x: number, y: number]} Point */

/** Draw a line through points. @param {Context} context @param {Point[]} points */
export function line(context, ...points) {
  context.beginPath();
  for (const point of points) context.lineTo(...point);
  context.stroke();
}

/** Fill the room between points. @param {Context} context @param {Point[]} points */
export function fill(context, ...points) {
  context.beginPath();
  for (const point of points) context.lineTo(...point);
  context.fill();
}

/**
 * Fill a disc.
 * @param {Context} context
 * @param {number} x
 * @param {number} y
 * @param {number} radius
 * @param {string | CanvasGradient} colour
 */
export function disc(context, x, y, radius, colour) {
  context.fillStyle = colour;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

/** A base for pictures, which say how they are drawn. */
export class Picture {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    const context = canvas.getContext("2d");
    if (!context) throw new Error("this browser has no canvas");
    this.context = context;
    this.width = 0;
    this.height = 0;
    this.isSeen = true;
    /** Asks for the next moment. */
    this.wake = () => {};
    this.isOutdated = true;
    this.drawnAt = 0; // s
    new ResizeObserver(() => {
      this.isStale = true;
    }).observe(canvas);
    new IntersectionObserver((entries) => {
      this.isSeen = entries[entries.length - 1].isIntersecting;
      this.isStale = true;
    }).observe(canvas);
  }

  /** Whether it has to be drawn and measured anew, even where nothing moves. */
  get isStale() {
    return this.isOutdated;
  }

  set isStale(isStale) {
    this.isOutdated = isStale;
    if (isStale) this.wake();
  }

  get colours() {
    return colours ?? readColours();
  }

  /** Draw one moment, if it can be seen and differs from the last. @param {Moment} moment */
  show(moment) {
    if (!this.isSeen) return;
    this.notice(moment);
    const lasted = moment.now - this.drawnAt;
    const isEarly = moment.isCalm && !this.isWanted && lasted < CALM;
    if (!this.isStale && (isEarly || !this.changes(moment))) return;
    const isFitted = this.isStale;
    if (isFitted) this.#fit();
    if (this.width === 0 || this.height === 0) return;
    if (isFitted) this.fitted();
    const elapsed = this.drawnAt ? Math.min(lasted, LONGEST) : 0;
    this.drawnAt = moment.now;
    this.context.clearRect(0, 0, this.width, this.height);
    this.draw({ ...moment, elapsed });
  }

  /** Whether all of it becomes larger on a large canvas. */
  get isMagnified() {
    return true;
  }

  /** Whether somebody has asked for its motion. */
  get isWanted() {
    return false;
  }

  /** Take note of a moment, whether or not it is drawn. @param {Moment} _moment */
  notice(_moment) {}

  /** Whether it has to be drawn again at a moment. @param {Moment} moment */
  changes(moment) {
    return moment.isNew || moment.isTouched;
  }

  /** Draw what stays until it is stale again. */
  fitted() {}

  /** Draw it, in px. @param {Moment} _moment */
  draw(_moment) {
    throw new Error("says each picture");
  }

  /** How much larger everything is than on a small canvas. */
  get zoom() {
    const { clientWidth, clientHeight } = this.canvas;
    const room = Math.min(clientWidth / LARGE.width, clientHeight / LARGE.height, LARGE.most);
    return this.isMagnified && this.canvas.closest(".large") ? Math.max(room, 1) : 1;
  }

  /** As many dots as the screen has. */
  #fit() {
    this.isStale = false;
    const { zoom } = this;
    const { clientWidth, clientHeight } = this.canvas;
    const dots = Math.min(devicePixelRatio || 1, MAX_DOTS);
    this.width = clientWidth / zoom;
    this.height = clientHeight / zoom;
    this.canvas.width = Math.round(clientWidth * dots);
    this.canvas.height = Math.round(clientHeight * dots);
    this.context.setTransform(dots * zoom, 0, 0, dots * zoom, 0, 0);
  }
}

/** Shows pictures, moment by moment. */
export class Gallery {
  /** @param {() => Snapshot | null} latest */
  constructor(latest) {
    this.latest = latest;
    /** @type {Picture[]} */
    this.pictures = [];
    this.calm = matchMedia("(prefers-reduced-motion: reduce)");
    /** @type {Snapshot | null} */
    this.seen = null;
    this.isAwake = false;
    this.isTouched = false;
    this.changedAt = 0; // ms
    this.wake();
  }

  /**
   * Draw from the next frame on, until nothing has changed for a while. The browser asks for no
   * frames while the page is hidden, so that nothing is drawn then.
   */
  wake() {
    this.isTouched = true;
    if (this.isAwake) return;
    this.isAwake = true;
    requestAnimationFrame((now) => this.#next(now));
  }

  /** @param {Picture} picture */
  add(picture) {
    this.pictures.push(picture);
    picture.wake = () => this.wake();
  }

  /** Draw all anew: the theme or the language has changed. */
  renew() {
    colours = null;
    for (const picture of this.pictures) picture.isStale = true;
  }

  /** @param {number} now ms */
  #next(now) {
    const { isTouched } = this;
    this.isAwake = this.isTouched = false;
    const state = this.latest();
    const isNew = state !== this.seen;
    /** @type {Moment} */
    const moment = {
      state, isNew, isTouched, now: now / 1000, elapsed: 0, isCalm: this.calm.matches,
    }; // prettier-ignore
    this.seen = state;
    for (const picture of this.pictures) picture.show(moment);
    if (isNew || isTouched) this.changedAt = now;
    if (this.isAwake || now - this.changedAt > RESTS_AFTER) return;
    this.isAwake = true;
    requestAnimationFrame((next) => this.#next(next));
  }
}
