// Driving: the arrow keys and the four buttons publish one velocity command each, as the keys of turtle_teleop_key do, and nothing stops
// the turtle but time. A key that is held repeats as the keyboard does, a button that is held as a terminal would. Names are those of
// the simulator's namespace, and so are the parameters that scale a command.

import { el, svg } from "./dom.js";
import { t } from "./texts.js";

const KEYS = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };
const SCALE = 2; // m/s and rad/s, the original's, unless the parameters say otherwise
const PARAMETERS = ["scale_linear", "scale_angular"];
const FIRST_REPEAT = 500; // ms
const REPEAT = 50;
const OWN_ARROWS = "input, select, [role=radiogroup], .scroll, .room, .room-controls, .own-arrows"; // these use the arrow keys themselves
const BUTTONS = [
  ["ArrowUp", t("forward"), "M6 2.5 10.5 8h-9z"],
  ["ArrowLeft", t("turn left"), "M2.5 6 8 1.5v9z"],
  ["ArrowDown", t("backward"), "M6 9.5 1.5 4h9z"],
  ["ArrowRight", t("turn right"), "M9.5 6 4 10.5v-9z"],
];

export class Drive {
  // publish(topic, type, message) sends; call(service, arguments) asks; turtle() names the turtle that is driven, with null none.
  constructor({ pad, publish, call, turtle }) {
    Object.assign(this, { publish, call, turtle });
    this.scales = [SCALE, SCALE];
    this.forget();
    this.timer = null;
    this.buttons = new Map(BUTTONS.map(([key, name, d]) => [key, this.#button(key, name, d)]));
    pad.append(...this.buttons.values());
    document.addEventListener("keydown", (event) => this.#key(event));
    document.addEventListener("keyup", ({ key }) => this.buttons.get(key)?.classList.remove("held"));
    window.addEventListener("blur", () => this.#release());
  }

  forget() {
    this.simulator = null;
    this.namespace = "/";
  }

  // Drive the turtles of the simulator of that name. Its parameters are read now, as a program that starts reads them.
  async enter(simulator) {
    this.simulator = simulator;
    this.namespace = simulator ? simulator.replace(/[^/]*$/, "") : "/";
    const scales = await Promise.all(PARAMETERS.map((name) => this.#scale(this.namespace + name)));
    if (this.simulator === simulator) this.scales = scales;
  }

  async #scale(name) {
    try {
      const { value } = await this.call("/rosapi/get_param", { name, default: String(SCALE) });
      const scale = parseFloat(JSON.parse(value));
      return Number.isFinite(scale) ? scale : SCALE;
    } catch {
      return SCALE; // nobody to ask
    }
  }

  press(key) {
    const [forward, turn] = KEYS[key];
    const [linear, angular] = this.scales;
    const message = { linear: { x: forward * linear, y: 0, z: 0 }, angular: { x: 0, y: 0, z: turn * angular } };
    this.publish(`${this.namespace}${this.turtle()}/cmd_vel`, "geometry_msgs/Twist", message);
  }

  #key(event) {
    if (!(event.key in KEYS) || event.ctrlKey || event.altKey || event.metaKey || event.target.closest?.(OWN_ARROWS) || !this.turtle()) return;
    event.preventDefault();
    this.buttons.get(event.key).classList.add("held");
    this.press(event.key);
  }

  #button(key, name, d) {
    const button = el("button", { type: "button", class: `arrow ${key}`, "aria-label": name, title: name },
      svg("svg", { viewBox: "0 0 12 12", "aria-hidden": "true" }, svg("path", { d })));
    button.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      button.setPointerCapture(event.pointerId);
      this.#release();
      this.press(key);
      this.timer = setTimeout(() => {
        this.timer = setInterval(() => this.press(key), REPEAT);
      }, FIRST_REPEAT);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(end, () => this.#release());
    button.addEventListener("click", (event) => {
      if (event.detail === 0) this.press(key); // Enter and the space bar; the pointer has been heard before
    });
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    return button;
  }

  #release() {
    clearTimeout(this.timer);
    clearInterval(this.timer);
    this.timer = null;
    for (const button of this.buttons.values()) button.classList.remove("held");
  }
}
