// What mouse, fingers and keys do on the picture: turn, shift and draw near the view, and drag an object. Keys: arrows turn, with Shift
// they shift, + and - draw near and away, 0 or Home shows everything.

const TURN = 0.008; // rad for each pixel
const KEY_TURN = 0.12; // rad
const KEY_SHIFT = 0.06; // of the picture's height
const WHEEL = 0.0015; // of a step of the wheel, which is some 100 pixels
const NEARER = 0.85;
const LINE = 16; // px of a line of the wheel
const CLICK = 4; // px within which a press is a click

export class Gestures {
  // camera() gives the Camera that is to be turned, when something is about to turn it; changed() after that. whole() shows everything.
  // grab(u, v): whether a drag of an object begins at that part of the picture; drag(u, v), drop(), cancel(); click(u, v).
  constructor(canvas, { camera, changed, whole, grab, drag, drop, cancel, click }) {
    Object.assign(this, { canvas, camera, changed, whole, grab, drag, drop, cancel, click });
    this.pointers = new Map(); // id → {x, y}
    this.dragging = null; // the id of the pointer that drags an object
    this.apart = null; // of two fingers: {distance, x, y}
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    canvas.addEventListener("pointerup", (event) => this.#up(event, true));
    canvas.addEventListener("pointercancel", (event) => this.#up(event, false));
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  #part({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect();
    return [(clientX - box.left) / box.width, (clientY - box.top) / box.height];
  }

  #down(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.apart = null;
    if (this.pointers.size === 1) {
      this.pressed = { x: event.clientX, y: event.clientY };
      if (event.button === 0 && !event.shiftKey && this.grab(...this.#part(event))) this.dragging = event.pointerId;
    } else {
      this.pressed = null;
      if (this.dragging !== null) {
        this.dragging = null;
        this.cancel();
      }
    }
  }

  #move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.clientX, y: event.clientY };
    this.pointers.set(event.pointerId, now);
    if (this.pressed && Math.hypot(now.x - this.pressed.x, now.y - this.pressed.y) < CLICK) return;
    this.pressed = null;
    if (this.dragging === event.pointerId) this.drag(...this.#part(event));
    else if (this.pointers.size === 1) this.#pull(event, now.x - before.x, now.y - before.y);
    else if (this.pointers.size === 2) this.#pinch();
  }

  #pull({ buttons, shiftKey }, across, down) {
    const camera = this.camera();
    const high = this.canvas.clientHeight || 1;
    if (shiftKey || buttons & 6) camera.pan(-across / high, down / high);
    else camera.orbit(-across * TURN, down * TURN);
    this.changed();
  }

  #pinch() {
    const [one, other] = [...this.pointers.values()];
    const now = { distance: Math.hypot(one.x - other.x, one.y - other.y), x: (one.x + other.x) / 2, y: (one.y + other.y) / 2 };
    const { apart } = this;
    this.apart = now;
    if (!apart) return;
    const camera = this.camera();
    const high = this.canvas.clientHeight || 1;
    if (now.distance > 0) camera.zoom(apart.distance / now.distance);
    camera.pan((apart.x - now.x) / high, (now.y - apart.y) / high);
    this.changed();
  }

  #up(event, done) {
    if (!this.pointers.delete(event.pointerId)) return;
    this.apart = null;
    const clicked = done && this.pressed;
    this.pressed = null;
    if (this.dragging === event.pointerId) {
      this.dragging = null;
      if (done && !clicked) this.drop();
      else this.cancel();
    }
    if (clicked) this.click(...this.#part(event));
  }

  #wheel(event) {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? LINE : 1);
    this.camera().zoom(Math.exp(Math.max(-400, Math.min(400, pixels)) * WHEEL));
    this.changed();
  }

  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const [across, up] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] ?? [0, 0];
    if (across || up) {
      if (event.shiftKey) this.camera().pan(across * KEY_SHIFT, up * KEY_SHIFT);
      else this.camera().orbit(across * KEY_TURN, up * KEY_TURN);
    } else if (event.key === "+" || event.key === "=") this.camera().zoom(NEARER);
    else if (event.key === "-") this.camera().zoom(1 / NEARER);
    else if (event.key === "0" || event.key === "Home") this.whole();
    else if (event.key === "Escape" && this.dragging !== null) {
      this.dragging = null;
      this.cancel();
    } else return;
    event.preventDefault();
    this.changed();
  }
}
