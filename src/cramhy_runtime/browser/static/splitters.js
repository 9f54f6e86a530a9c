// The bars between the parts of the page, by which their sizes are changed: with the mouse or a finger, or with the arrow keys, Home and End.
// Enter and a double click give the sizes with which the page begins. Sizes are kept for each layout of `tab.css` by itself.

import { byId } from "./dom.js";
import { keep, kept } from "./settings.js";

const LEAST = 140; // px that a part has at least
const STEP = 0.02; // of the room of both parts, for an arrow key
const TWICE = 400; // ms between two presses that are one double click; of a finger there is no dblclick
const SLIP = 3; // px that a press may move and is no drag
const NAMES = ["lesson", "repl", "live"];

// The parts before and behind a bar, that are shown.
const PARTS = {
  lesson: () => [byId("lesson"), byId("code")],
  repl: () => [[byId("code"), byId("lesson")].find((part) => part.checkVisibility()), byId("repl")],
  live: () => {
    const both = [document.querySelector(".desk"), document.querySelector(".live")];
    return layout() === "upright" ? both.reverse() : both;
  },
};

const layout = () => getComputedStyle(document.body).getPropertyValue("--layout").trim();

class Splitter {
  constructor(name) {
    this.name = name;
    this.bar = byId(`split-${name}`);
    this.pressed = -Infinity; // ms: when it was pressed last, and not moved
    this.grabbed = null; // px from the begin of the bar to the pointer that holds it
    const on = (kind, act) => this.bar.addEventListener(kind, act);
    on("pointerdown", (event) => this.#grab(event));
    on("pointermove", (event) => this.#drag(event));
    for (const kind of ["pointerup", "pointercancel"]) on(kind, () => this.#release());
    on("keydown", (event) => this.#key(event));
  }

  get #place() {
    return `split-${layout()}-${this.name}`;
  }

  // Sizes as they were left in this layout.
  restore() {
    if (!this.bar.checkVisibility()) return;
    const share = Number(kept(this.#place, ""));
    if (share > 0 && share < 1) this.#set(this.#clamped(share));
    else this.#forget();
    this.tell();
  }

  // How the bar lies, and what a screen reader says of it.
  tell() {
    if (!this.bar.checkVisibility()) return;
    const { share, least } = this.#measured();
    const told = { orientation: this.across ? "vertical" : "horizontal", valuenow: share, valuemin: least, valuemax: 1 - least };
    for (const [name, value] of Object.entries(told)) {
      this.bar.setAttribute(`aria-${name}`, typeof value === "number" ? Math.round(value * 100) : value);
    }
  }

  // Whether the parts stand side by side.
  get across() {
    const { width, height } = this.bar.getBoundingClientRect();
    return width < height;
  }

  // In px where the first part begins and how much room both have; the share of the first, and the least one.
  #measured() {
    const [first, second] = PARTS[this.name]().map((part) => part.getBoundingClientRect());
    const [begin, end] = this.across ? ["left", "right"] : ["top", "bottom"];
    const bar = this.bar.getBoundingClientRect();
    const room = second[end] - first[begin] - (bar[end] - bar[begin]);
    return { begin: first[begin], room, share: (bar[begin] - first[begin]) / room, least: Math.min(0.5, LEAST / room) };
  }

  #clamped(share) {
    const { least } = this.#measured();
    return Math.min(1 - least, Math.max(least, share));
  }

  #set(share) {
    const { style } = document.body;
    style.setProperty(`--${this.name}-before`, `${(share * 100).toFixed(2)}fr`);
    style.setProperty(`--${this.name}-after`, `${(100 - share * 100).toFixed(2)}fr`);
  }

  #forget() {
    for (const side of ["before", "after"]) document.body.style.removeProperty(`--${this.name}-${side}`);
  }

  // Another share, by the user.
  #change(share) {
    const clamped = this.#clamped(share);
    this.#set(clamped);
    keep(this.#place, clamped.toFixed(4));
    this.tell();
  }

  #reset() {
    this.#forget();
    keep(this.#place, "");
    this.tell();
  }

  #grab(event) {
    if (event.button !== 0) return;
    if (event.timeStamp - this.pressed < TWICE) {
      this.pressed = -Infinity;
      this.#reset();
      return;
    }
    this.pressed = event.timeStamp;
    const { left, top } = this.bar.getBoundingClientRect();
    this.from = this.#along(event);
    this.grabbed = this.from - (this.across ? left : top);
    this.bar.setPointerCapture(event.pointerId);
    this.bar.classList.add("held");
  }

  #drag(event) {
    if (this.grabbed === null || (this.pressed > 0 && Math.abs(this.#along(event) - this.from) < SLIP)) return;
    this.pressed = -Infinity;
    const { begin, room } = this.#measured();
    this.#change((this.#along(event) - this.grabbed - begin) / room);
  }

  #along(event) {
    return this.across ? event.clientX : event.clientY;
  }

  #release() {
    this.grabbed = null;
    this.bar.classList.remove("held");
  }

  #key(event) {
    const { share, least } = this.#measured();
    const step = event.shiftKey ? 5 * STEP : STEP;
    const [less, more] = this.across ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const wanted = { [less]: share - step, [more]: share + step, Home: least, End: 1 - least }[event.key];
    if (wanted !== undefined) this.#change(wanted);
    else if (event.key === "Enter") this.#reset();
    else return;
    event.preventDefault();
  }
}

export function offerSplitters() {
  const all = NAMES.map((name) => new Splitter(name));
  let shown = null;
  new ResizeObserver(() => {
    const now = layout();
    for (const each of all) now === shown ? each.tell() : each.restore();
    shown = now;
  }).observe(document.body);
  new ResizeObserver(() => all.forEach((each) => each.tell())).observe(document.querySelector(".desk"));
}
