// The robot's world as it is seen: the picture, the view on it, what is chosen, and the objects that a hand moves. Live, motions are played one
// after the other; of the past it shows one moment. A frame is drawn only when something has changed.

import { el, setAttribute, setText, svg } from "../dom.js";
import { decimal } from "../format.js";
import { keep, kept, offerSwitch } from "../settings.js";
import { Camera, corners, rayThrough, robotsView, seenAt } from "./camera.js";
import { Gestures } from "./gestures.js";
import { linkPoses, place } from "./kinematics.js";
import { add, compose, turned, yaw } from "./maths.js";
import { Motion } from "./motion.js";
import { NOTHING, bytes } from "./news.js";
import { boxAround, firstMet, heightOf, onLevel } from "./pointing.js";
import { Renderer } from "./renderer.js";
import { addFrames, addGrasps, addOffset, addPaths } from "./sketches.js";
import { Sharpness } from "./sharpness.js";
import { Surface } from "./solids.js";
import { t } from "../texts.js";

const LIGHT = { sky: [0.925, 0.94, 0.955], one: [0.84, 0.835, 0.815], other: [0.79, 0.785, 0.765], accent: [0.05, 0.62, 0.52], edge: 0.45 };
const DARK = { sky: [0.08, 0.09, 0.1], one: [0.175, 0.185, 0.2], other: [0.145, 0.155, 0.17], accent: [0.37, 0.9, 0.75], edge: 0.55 };
const BELIEVED = [0.62, 0.2, 0.85];
const LEVEL = 0.7; // how far the normal of a surface points up, on which an object may be put
const LIFT = 0.01; // m above the place where it is let go
const NUDGE = 0.05; // m
const APART = 0.03; // m between two places of a path
const LONGEST = 4000; // places of a path
const FREE = "";
const SHOWS = [
  ["path", t("Path"), true, t("Where the base of the robot has been")],
  ["belief", t("Belief"), true, t("Where the robot has perceived objects, beside where they are")],
  ["grasps", t("Grasps"), false, t("Poses to which the tools were to go: green where they were reached, red where not")],
  ["costmap", t("Costmap"), true, t("From where places were drawn last: the brighter, the more probable")],
  ["frames", t("Frames"), false, t("Frames of the room, of objects and of links: x red, y green, z blue")],
];
const ARROWS = [
  ["ArrowUp", t("away"), "M6 2.5 10.5 8h-9z", [0, 1]],
  ["ArrowLeft", t("to the left"), "M2.5 6 8 1.5v9z", [-1, 0]],
  ["ArrowDown", t("nearer"), "M6 9.5 1.5 4h9z", [0, -1]],
  ["ArrowRight", t("to the right"), "M9.5 6 4 10.5v-9z", [1, 0]],
];
const ORDER = new Intl.Collator("en", { numeric: true });

export class Room {
  // stage: the element that gets the picture; controls: the one that gets the buttons. move(name, place): asks the session to put an
  // object somewhere. failed(error), say(text) tell the user.
  constructor({ stage, controls, move, failed, say }) {
    Object.assign(this, { move, failed, say });
    this.known = NOTHING;
    this.motion = new Motion(() => matchMedia("(prefers-reduced-motion: reduce)").matches);
    this.past = null; // what was known at the moment of the past that is shown
    this.ways = new Map(); // robot → places of its base
    this.camera = new Camera();
    this.framed = false; // whether the camera has been turned to the world
    this.shows = {};
    this.chosen = null;
    this.held = null; // the object that is being dragged: {name, place, away, z}
    this.placed = new Map();
    this.placedOf = null;
    this.extra = new Surface();
    this.over = new Surface();
    this.dirty = true;
    this.sharpness = new Sharpness();
    this.chips = new Map();
    this.#build(stage, controls);
    this.renderer = new Renderer(this.canvas);
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => this.#restore());
    new ResizeObserver(() => this.#fit()).observe(this.canvas);
    this.gestures = new Gestures(this.canvas, {
      camera: () => this.#free(), changed: () => (this.dirty = true), whole: () => this.whole(),
      grab: (u, v) => this.#grab(u, v), drag: (u, v) => this.#drag(u, v), drop: () => this.#drop(), cancel: () => this.#let(),
      click: (u, v) => this.#click(u, v),
    });
    const recolour = () => {
      this.colours = isDark() ? DARK : LIGHT;
      this.dirty = true;
    };
    recolour();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour);
    new MutationObserver(recolour).observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
  }

  // ------------------------------------------------------------------------------------------------------------- what is told

  // Everything anew: what is `known` of the live session.
  restart(known) {
    this.motion.forget();
    this.ways.clear();
    this.#learn(known);
    this.motion.states = new Map(known.states);
    this.#walk();
  }

  // A RobotWorld, after which `known` is known.
  hear(message, known) {
    if (message.complete) {
      this.restart(known);
      return;
    }
    for (const name of message.removed ?? []) this.motion.drop(name);
    this.#learn(known, message.things?.length || message.removed?.length);
    this.motion.add(message.steps ?? []);
    if (!this.motion.moving) this.#walk();
  }

  #learn(known, others = true) {
    const marks = known.marks !== this.known.marks;
    this.known = known;
    if (this.past) return;
    if (others) this.#takeThings();
    if (marks) this.#takeMarks();
    this.dirty = true;
    this.placedOf = null;
  }

  // Show what was known at a moment of the past, or with null the live world. text: what to say of it.
  showPast(known, text = "") {
    this.past = known;
    this.note.hidden = !known;
    setText(this.note, text);
    this.#let();
    this.#takeThings();
    this.#takeMarks();
  }

  get now() {
    return this.past ?? this.known;
  }

  #takeThings() {
    const { things } = this.now;
    this.renderer.take(things);
    this.placedOf = null;
    this.dirty = true;
    if (!this.framed && things.size) this.whole();
    const cameras = [...things.values()].flatMap(({ name, kind, cameras: all, links }) =>
      (kind === "robot" ? all : []).filter((camera) => links.some((link) => link.name === camera)).map((camera) => [name, camera]));
    this.#offerViews(cameras);
    this.#offerObjects();
  }

  #takeMarks() {
    const map = this.now.marks?.costmap?.[0];
    const cells = map && bytes(map.cells);
    this.renderer.setCostmap(this.shows.costmap && map && cells.length === map.columns * map.rows ? { ...map, cells } : null);
    this.dirty = true;
  }

  // Note where the robots' bases are.
  #walk() {
    for (const [name, { pose }] of this.motion.states) {
      if (this.known.things.get(name)?.kind !== "robot") continue;
      let way = this.ways.get(name);
      if (!way) this.ways.set(name, (way = []));
      const last = way.at(-1);
      if (last && Math.hypot(last[0] - pose[0], last[1] - pose[1]) < APART) continue;
      way.push([pose[0], pose[1]]);
      if (way.length > LONGEST) way.splice(0, way.length / 4);
    }
  }

  // ---------------------------------------------------------------------------------------------------------------- the picture

  // Draw what is due at `now` (ms), if anything has changed.
  frame(now) {
    if (this.motion.advance(now) && !this.past) {
      this.dirty = true;
      this.placedOf = null;
      this.#walk();
    }
    if (this.renderer.gl.isContextLost() || !this.canvas.checkVisibility()) return;
    const scale = this.sharpness.at(now, this.dirty);
    if (!scale) return;
    this.dirty = false;
    this.#size(scale);
    const placed = this.#place();
    const { marks, things } = this.now;
    const { extra, over } = this;
    extra.clear();
    over.clear();
    const ghosts = [];
    if (this.shows.path && !this.past) addPaths(extra, this.ways);
    if (this.shows.belief) {
      for (const { name, pose } of marks?.seen ?? []) {
        const thing = things.get(name);
        if (!thing) continue;
        ghosts.push({ name, poses: linkPoses(thing, { pose, joints: [] }), colour: BELIEVED });
        if (placed.has(name)) addOffset(extra, pose, placed.get(name)[0], BELIEVED);
      }
    }
    if (this.shows.grasps) addGrasps(over, marks?.grasps ?? []);
    const view = this.view();
    if (this.shows.frames) addFrames(over, things, placed, view.eye);
    this.renderer.draw({ view, placed, extra, over, ghosts, lit: this.held?.name ?? this.chosen, colours: this.colours });
    this.#tag(view, placed);
  }

  // Where the links of all things are, as they are shown.
  #place() {
    if (!this.placedOf) {
      let { states } = this.past ?? this.motion;
      if (this.held?.place && states.has(this.held.name)) {
        const state = states.get(this.held.name);
        const pose = [...this.held.place, ...state.pose.slice(3)];
        states = new Map(states).set(this.held.name, { ...state, pose, holder: "" });
      }
      this.placed = place(this.now.things, states);
      this.placedOf = states;
    }
    return this.placed;
  }

  // What the picture is seen with: our camera, or a robot's.
  view() {
    const [name, camera] = this.eyes.value.split("\n");
    const thing = this.now.things.get(name);
    const number = thing?.links.findIndex((link) => link.name === camera) ?? -1;
    const pose = number >= 0 ? this.#place().get(name)?.[number] : null;
    return pose ? robotsView(pose, thing.opening) : this.camera.view();
  }

  // The camera that gestures turn: it takes over from a robot's, where that is.
  #free() {
    if (this.eyes.value !== FREE) {
      this.camera.from(this.view());
      this.eyes.value = FREE;
      keep("room-view", FREE);
    }
    return this.camera;
  }

  // Show all of the world.
  whole() {
    const placed = this.#place();
    const places = [];
    for (const [name, { links }] of this.now.things) {
      placed.get(name)?.forEach((pose, number) => {
        for (const shape of links[number].shapes) {
          if (shape.kind === "plane") continue;
          const [from, to] = boxAround(shape);
          const at = compose(pose, shape.frame);
          places.push(...corners(from, to).map((corner) => add(at, turned(at, corner))));
        }
      });
    }
    this.eyes.value = FREE;
    if (places.length) this.camera.overview(places, this.#aspect);
    this.framed = this.canvas.clientWidth > 1;
    this.dirty = true;
  }

  get #aspect() {
    return Math.max(1, this.canvas.clientWidth) / Math.max(1, this.canvas.clientHeight);
  }

  #fit() {
    if (!this.framed) this.whole();
    this.dirty = true;
  }

  // scale: pixels of the picture for each pixel of the page.
  #size(scale) {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((side) => Math.max(1, Math.round(side * scale)));
    if (width === this.canvas.width && height === this.canvas.height) return;
    this.canvas.width = width;
    this.canvas.height = height;
  }

  #restore() {
    this.renderer.begin();
    this.#takeThings();
    this.#takeMarks();
  }

  // ------------------------------------------------------------------------------------------------------------ what is chosen

  choose(name, link = "") {
    this.chosen = name;
    this.link = link;
    this.dirty = true;
    this.read();
  }

  #click(u, v) {
    const hit = firstMet(this.#ray(u, v), this.now.things, this.#place());
    const thing = hit && this.now.things.get(hit.name);
    if (!thing || thing.kind === "ground") this.choose(null);
    else this.choose(hit.name, thing.links[hit.link].name);
  }

  // The read-out, and the objects to choose from; less often than the picture.
  read() {
    const { things, states } = this.now;
    if (this.chosen && !things.has(this.chosen)) this.choose(null);
    const pose = this.#place().get(this.chosen)?.[0];
    const state = states.get(this.chosen);
    const told = pose
      ? { x: decimal(pose[0]), y: decimal(pose[1]), z: decimal(pose[2]), yaw: `${Math.round(yaw(pose))}°`, held: state?.holder || "–" }
      : {};
    for (const [key, node] of Object.entries(this.values)) setText(node, told[key] ?? "–");
    setText(this.title, this.chosen ?? t("nothing chosen"));
    const movable = Boolean(things.get(this.chosen)?.movable) && !this.past;
    for (const button of this.pad.children) button.disabled = !movable;
    for (const [name, chip] of this.chips) setAttribute(chip, "aria-pressed", String(name === this.chosen));
  }

  // The name of what is chosen, beside it.
  #tag(view, placed) {
    const pose = placed.get(this.held?.name ?? this.chosen)?.[0];
    const spot = pose && seenAt(view, pose, this.#aspect);
    this.tag.hidden = !spot || spot[0] < 0 || spot[0] > 1 || spot[1] < 0 || spot[1] > 1;
    if (this.tag.hidden) return;
    setText(this.tag, this.held ? this.held.name : this.link && this.link !== this.chosen ? `${this.chosen}: ${this.link}` : this.chosen);
    this.tag.style.setProperty("--u", `${(spot[0] * 100).toFixed(2)}%`);
    this.tag.style.setProperty("--v", `${(spot[1] * 100).toFixed(2)}%`);
  }

  // ------------------------------------------------------------------------------------------------------------------ by hand

  #ray(u, v) {
    return rayThrough(this.view(), u, v, this.#aspect);
  }

  #grab(u, v) {
    if (this.past) return false;
    const ray = this.#ray(u, v);
    const hit = firstMet(ray, this.known.things, this.#place());
    const thing = hit && this.known.things.get(hit.name);
    if (!thing?.movable) return false;
    const state = this.known.states.get(hit.name);
    if (state.holder) {
      this.say(t("{holder} holds {name} with {link}, so it cannot be moved by hand. Let the plan put it down first.", { ...state, name: hit.name }), "bad");
      return false;
    }
    this.motion.hurry();
    this.placedOf = null;
    const poses = this.#place().get(hit.name);
    const foot = heightOf(thing, poses);
    const base = onLevel(ray, foot) ?? hit.place;
    const from = poses[0].slice(0, 3);
    this.held = { name: hit.name, place: null, foot, above: from[2] - foot, away: [from[0] - base[0], from[1] - base[1]] };
    this.choose(hit.name);
    return true;
  }

  // The held object goes to the surface below the pointer, or stays at its height where there is none that one can put it on.
  #drag(u, v) {
    const { held } = this;
    const ray = this.#ray(u, v);
    const hit = firstMet(ray, this.known.things, this.placed, held.name);
    const on = hit && hit.normal[2] > LEVEL ? hit.place : onLevel(ray, held.foot);
    if (!on) return;
    held.foot = on[2];
    held.place = [on[0] + held.away[0], on[1] + held.away[1], on[2] + held.above];
    this.placedOf = null;
    this.dirty = true;
  }

  #drop() {
    const { held } = this;
    if (held?.place) this.#put(held.name, add(held.place, [0, 0, LIFT]));
    else this.#let();
  }

  async #put(name, spot) {
    try {
      await this.move(name, spot);
    } catch (error) {
      this.failed(error);
    }
    this.motion.hurry(); // where it lies now has been told before the answer
    this.#let();
    this.read();
  }

  #let() {
    this.held = null;
    this.placedOf = null;
    this.dirty = true;
  }

  // Move the chosen object a little, as it is seen: to the right, away.
  nudge(across, away) {
    const thing = this.known.things.get(this.chosen);
    if (!thing?.movable || this.past) return;
    this.motion.hurry();
    this.placedOf = null;
    const { right } = this.view();
    const size = Math.hypot(right[0], right[1]) || 1;
    const [x, y] = [right[0] / size, right[1] / size];
    const pose = this.#place().get(this.chosen)[0];
    this.#put(this.chosen, [pose[0] + NUDGE * (across * x - away * y), pose[1] + NUDGE * (across * y + away * x), pose[2] + LIFT]);
  }

  // ------------------------------------------------------------------------------------------------------------- the elements

  #build(stage, controls) {
    this.canvas = el("canvas", {
      id: "room", width: 1, height: 1, tabindex: 0, role: "application", "aria-roledescription": t("view of the robot's world"),
      "aria-label": t("The robot's world. Arrow keys turn the view, with Shift they shift it; plus and minus go nearer and away; 0 shows everything."),
    });
    this.tag = el("p", { class: "tag", "aria-hidden": "true", hidden: true });
    this.note = el("p", { class: "past", hidden: true });
    this.element = el("div", { class: "room" }, this.canvas, this.tag, this.note);
    stage.append(this.element);

    this.eyes = el("select", { id: "room-view" }, new Option(t("free"), FREE));
    this.eyes.addEventListener("change", () => {
      keep("room-view", this.eyes.value);
      this.dirty = true;
    });
    const whole = el("button", { type: "button", id: "room-whole", title: t("Show everything"), on: { click: () => this.whole() } }, t("Whole view"));
    const shows = SHOWS.map(([name, text, on, title]) => {
      const button = el("button", { type: "button", id: `room-${name}`, class: "chip", "aria-pressed": String(on), title }, text);
      offerSwitch(button, `room-${name}`, (now) => {
        this.shows[name] = now;
        this.dirty = true;
        if (name === "costmap" && this.renderer) this.#takeMarks();
      });
      return button;
    });
    this.title = el("span", { class: "chosen" }, t("nothing chosen"));
    this.values = {};
    const readings = [["x", "x, m"], ["y", "y, m"], ["z", "z, m"], ["yaw", "yaw"], ["held", t("held by")]].map(([key, text]) => {
      this.values[key] = el("span", {}, "–");
      const definition = el("dd", {}, this.values[key]);
      definition.dataset.reading = `room-${key}`;
      return el("div", {}, el("dt", {}, text), definition);
    });
    this.objects = el("div", { class: "objects", role: "group", "aria-label": t("Objects") });
    this.pad = el("div", { class: "pad", role: "group", "aria-label": t("Move the chosen object by hand") });
    for (const [key, text, d, [across, away]] of ARROWS) {
      const title = t("Move the chosen object 5 cm {where}", { where: text });
      this.pad.append(el("button", { type: "button", class: `arrow ${key}`, "aria-label": title, title, on: { click: () => this.nudge(across, away) } },
        svg("svg", { viewBox: "0 0 12 12", "aria-hidden": "true" }, svg("path", { d }))));
    }
    controls.append(el("div", { class: "room-controls" },
      el("div", { class: "commands" }, el("label", { class: "field" }, el("span", {}, t("view")), this.eyes), whole,
        el("div", { class: "shows", role: "group", "aria-label": t("Shown in the room") }, ...shows)),
      el("div", { class: "under" }, el("div", { class: "read" }, this.title, el("dl", { class: "pose" }, ...readings)), this.pad),
      this.objects));
  }

  #offerViews(cameras) {
    const wanted = this.eyes.value || kept("room-view", FREE);
    const options = cameras.map(([name, camera]) => new Option(`${name}: ${camera.replace(/_optical_frame$/, "").replaceAll("_", " ")}`, `${name}\n${camera}`));
    this.eyes.replaceChildren(new Option(t("free"), FREE), ...options);
    this.eyes.value = options.some(({ value }) => value === wanted) ? wanted : FREE;
  }

  #offerObjects() {
    const names = [...this.now.things.values()].filter(({ kind }) => kind === "object").map(({ name }) => name).sort(ORDER.compare);
    if (names.length === this.chips.size && names.every((name) => this.chips.has(name))) return;
    this.chips = new Map(names.map((name) => [name, el("button", {
      type: "button", class: "chip", "aria-pressed": String(name === this.chosen), on: { click: () => this.choose(name === this.chosen ? null : name) },
    }, name)]));
    this.objects.replaceChildren(...this.chips.values());
  }
}

function isDark() {
  const { theme } = document.documentElement.dataset;
  return theme === "dark" || (theme !== "light" && matchMedia("(prefers-color-scheme: dark)").matches);
}
