// The world as it is seen: the canvas with paper and turtles, the turtle that is chosen, and where it is. Live, the picture follows the
// ticks smoothly; of the past it shows one moment. Grid, goals and way can be shown with it, and where the pointer is.

import { arrange, el, setAttribute, setText, svg } from "./dom.js";
import { decimal } from "./format.js";
import { WaySheet, drawGoals, drawGrid, drawing } from "./marks.js";
import { Paper, drawWorld, toWorld } from "./paper.js";
import { Playback } from "./playback.js";
import { t } from "./texts.js";
import { Way } from "./way.js";

const NEAR = 0.7; // m from a turtle, within which a click means it
const TYPE = 0.75; // of the page's letters: those on the paper
const ORDER = new Intl.Collator("en", { numeric: true }); // turtle2 before turtle10

export class WorldView {
  // The elements of the page, the strokes, the pictures.
  constructor({ canvas, empty, turtles, pose, where, strokes, pictures }) {
    Object.assign(this, { canvas, empty, list: turtles, where, strokes, pictures });
    this.way = new Way();
    this.sheet = new WaySheet(this.way);
    this.goals = [];
    this.shows = {}; // "grid", "goals", "way" → whether it is shown
    this.pen = canvas.getContext("2d", { alpha: false });
    this.paper = new Paper(strokes);
    this.playback = new Playback();
    this.past = null;
    this.shown = null;
    this.chosen = "turtle1";
    this.dirty = true;
    this.chips = new Map();
    this.readings = readings(pose);
    new ResizeObserver(() => this.#fit()).observe(canvas);
    canvas.addEventListener("click", (event) => this.#pick(event));
    turtles.addEventListener("keydown", (event) => this.#step(event));
    canvas.addEventListener("pointermove", (event) => this.#point(event));
    for (const end of ["pointerleave", "pointercancel"]) canvas.addEventListener(end, () => (where.hidden = true));
  }

  // Whether the grid, the goals or the way is shown.
  show(what, on) {
    this.shows[what] = on;
    this.dirty = true;
  }

  // A tick {stamp, turtles, strokes, epoch} of the live world.
  tick(sample, arrival) {
    this.playback.push(sample, arrival);
    this.way.note(sample.stamp, sample.turtles);
    if (this.strokes.full) this.paper.settle(); // also while nobody draws: the page is hidden, or the past is looked at
  }

  forget() {
    this.playback.clear();
    this.paper.forget();
    this.way.forget();
    this.dirty = true;
  }

  // Show `sample` of the past, or with null the live world.
  showPast(sample) {
    this.past = sample;
    this.dirty = true;
  }

  // Draw what is due at `now` (ms).
  frame(now) {
    const sample = this.past ?? this.playback.at(now);
    if (!sample) return;
    const changed = this.paper.show(sample.strokes, sample.epoch);
    if (!this.dirty && !changed && sample === this.shown) return;
    this.dirty = false;
    this.shown = sample;
    drawWorld(this.pen, this.canvas.width, this.paper, sample.turtles, this.pictures, this.chosen, () => this.#marks(sample));
  }

  #marks({ stamp, epoch }) {
    const { grid, goals, way } = this.shows;
    const side = this.canvas.width;
    const letters = parseFloat(getComputedStyle(this.canvas).fontSize) * TYPE * (side / Math.max(1, this.canvas.clientWidth));
    const paper = drawing(this.pen, side, epoch?.colour ?? [0, 0, 0], letters);
    if (grid) drawGrid(paper);
    if (way) this.sheet.show(paper, epoch?.stamp ?? -Infinity, stamp);
    if (goals) drawGoals(paper, this.goals);
  }

  // The read-out beside the paper, and the goals of `modules`; less often than the picture.
  read(modules) {
    const goals = modules.flatMap((module) => pairs(module.goals ?? []));
    if (JSON.stringify(goals) !== JSON.stringify(this.goals)) this.dirty = true;
    this.goals = goals;
    this.#tell();
  }

  #tell() {
    const turtles = this.shown?.turtles ?? [];
    this.empty.hidden = !this.shown || turtles.length > 0;
    if (turtles.length && !turtles.some((turtle) => turtle.name === this.chosen)) this.choose(turtles[0].name);
    this.#chips(turtles);
    const turtle = turtles.find(({ name }) => name === this.chosen);
    for (const [key, node] of Object.entries(this.readings.values)) setText(node, turtle ? this.readings.text[key](turtle) : "–");
    this.readings.swatch.setAttribute("fill", turtle?.pen ? `rgb(${turtle.r} ${turtle.g} ${turtle.b})` : "none");
  }

  choose(name) {
    if (name === this.chosen) return;
    this.chosen = name;
    this.dirty = true;
    this.#scroll();
  }

  // Have the chosen turtle in sight among those to choose from.
  #scroll() {
    const { offsetLeft: left = 0, offsetWidth: width = 0 } = this.chips.get(this.chosen) ?? {};
    this.list.scrollLeft = Math.max(left + width - this.list.clientWidth, Math.min(left, this.list.scrollLeft));
  }

  get names() {
    return (this.shown?.turtles ?? []).map(({ name }) => name).sort(ORDER.compare);
  }

  #chips(turtles) {
    setAttribute(this.list, "hidden", turtles.length < 2 ? "" : null);
    const pictures = new Map(turtles.map(({ name, picture }) => [name, picture]));
    const names = this.names;
    const others = names.length !== this.chips.size;
    const nodes = names.map((name) => {
      let chip = this.chips.get(name);
      if (!chip) {
        chip = el("button", { type: "button", role: "radio", class: "chip", on: { click: () => this.choose(name) } }, name);
        chip.dataset.name = name;
        this.chips.set(name, chip);
      }
      chip.style.setProperty("--shell", this.pictures.shell(pictures.get(name)));
      setAttribute(chip, "aria-checked", String(name === this.chosen));
      setAttribute(chip, "tabindex", name === this.chosen ? "0" : "-1");
      return chip;
    });
    arrange(this.list, nodes);
    for (const name of this.chips.keys()) if (!pictures.has(name)) this.chips.delete(name);
    if (others) this.#scroll();
  }

  #step(event) {
    const step = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1 }[event.key];
    const names = this.names;
    if (!step || !names.length) return;
    event.preventDefault();
    this.choose(names[(names.indexOf(this.chosen) + step + names.length) % names.length]);
    this.#tell();
    this.chips.get(this.chosen)?.focus();
  }

  #pick(event) {
    const box = this.canvas.getBoundingClientRect();
    const { x, y } = toWorld((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    const near = (this.shown?.turtles ?? [])
      .map(({ name, ...place }) => ({ name, distance: Math.hypot(place.x - x, place.y - y) }))
      .filter(({ distance }) => distance < NEAR)
      .sort((one, other) => one.distance - other.distance);
    if (near.length) this.choose(near[0].name);
  }

  // Tell where the pointer is in the world.
  #point(event) {
    const box = this.canvas.getBoundingClientRect();
    const { x, y } = toWorld((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    this.where.hidden = false;
    setText(this.where, `x ${decimal(x)}  y ${decimal(y)}`);
  }

  // As many pixels as the screen has for it.
  #fit() {
    const side = Math.max(1, Math.round(this.canvas.clientWidth * Math.min(window.devicePixelRatio || 1, 3)));
    if (side === this.canvas.width) return;
    this.canvas.width = this.canvas.height = side;
    this.dirty = true;
  }
}

// [x, y, x, y ...] as points.
const pairs = (numbers) => Array.from({ length: numbers.length >> 1 }, (_, at) => ({ x: numbers[2 * at], y: numbers[2 * at + 1] }));

function readings(list) {
  const text = {
    x: (turtle) => decimal(turtle.x),
    y: (turtle) => decimal(turtle.y),
    theta: (turtle) => decimal(turtle.theta),
    speed: (turtle) => decimal(turtle.linear_velocity),
    turn: (turtle) => decimal(turtle.angular_velocity),
    pen: (turtle) => (turtle.pen ? `${turtle.width} px` : "up"),
  };
  const units = { x: "x, m", y: "y, m", theta: "θ, rad", speed: "v, m/s", turn: "ω, rad/s", pen: t("pen") };
  const values = {};
  const swatch = svg("rect", { x: 0.5, y: 0.5, width: 11, height: 11, rx: 3, id: "swatch" });
  for (const key of Object.keys(text)) {
    const value = (values[key] = el("span", {}, "–"));
    const definition = el("dd", {}, value);
    if (key === "pen") definition.prepend(svg("svg", { viewBox: "0 0 12 12", "aria-hidden": "true", class: "swatch" }, swatch));
    definition.dataset.reading = key;
    list.append(el("div", {}, el("dt", {}, units[key]), definition));
  }
  return { text, values, swatch };
}
