// The time line: all that is remembered from its beginning to now, with the tasks of that time as bars, and a slider to go back.
// "Live" returns to the present. The slider is the browser's own, so it works with a finger, a mouse and the keys.

import { arrange, setAttribute, svg } from "./dom.js";
import { clock } from "./format.js";
import { told } from "./state.js";
import { t } from "./texts.js";

const WIDTH = 1000;
const LANES = 4;
const LANE = 8;
const MOST_BARS = 240;
const TICK = 0.016;

export class Timeline {
  // seek(stamp) shows that moment, live() the present.
  constructor({ slider, strip, button, seek, live }) {
    Object.assign(this, { slider, strip, button, seek, live });
    this.past = null; // the moment that is shown, or null
    this.bars = new Map(); // id → rect
    this.range = { start: 0, end: 0 };
    slider.addEventListener("input", () => this.go(Number(slider.value)));
    slider.addEventListener("keydown", (event) => this.#key(event));
    button.addEventListener("click", () => this.present());
  }

  // Show the moment `stamp`; at the end of the line that is the present, unless it is a recording.
  go(stamp) {
    const { start, end } = this.range;
    if (stamp >= end && !this.recording) return this.present();
    this.past = Math.max(start, Math.min(stamp, end));
    this.#mark();
    this.seek(this.past);
  }

  // start, end: what is remembered. now: the present. recording: whether there is no present but the recording's time.
  render({ tasks, start, end, now, recording }) {
    this.recording = recording;
    this.range = { start, end };
    const { slider } = this;
    setAttribute(slider, "min", start);
    setAttribute(slider, "max", end);
    const value = this.past ?? (recording ? now : end);
    if (Number(slider.value) !== value) slider.value = value;
    this.#mark(value);
    this.#strip(tasks, start, end, now);
  }

  // Back to the present.
  present() {
    this.past = null;
    this.slider.value = this.range.end;
    this.#mark();
    this.live();
  }

  #mark(value = this.past ?? this.range.end) {
    setAttribute(this.button, "aria-pressed", String(this.past === null));
    this.button.hidden = Boolean(this.recording);
    // Live it does not change, since a reader of the screen would say every change.
    const text = this.past === null && !this.recording ? t("live") : t("{moment} of {end}", { moment: clock(value), end: clock(this.range.end) });
    setAttribute(this.slider, "aria-valuetext", text);
  }

  #key(event) {
    const { start, end } = this.range;
    const hundredth = Math.max((end - start) / 100, TICK);
    const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 };
    if (!(event.key in steps) || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    this.go((this.past ?? Number(this.slider.value)) + steps[event.key] * (event.shiftKey ? TICK : hundredth));
    this.slider.value = this.past ?? end;
  }

  #strip(tasks, start, end, now) {
    const span = Math.max(end - start, 1e-9);
    const nodes = [];
    const lanes = new Map();
    const seen = [];
    for (const task of tasks.values()) {
      const lane = tasks.has(task.parent) ? (lanes.get(task.parent) ?? 0) + 1 : 0;
      lanes.set(task.id, lane);
      if (lane < LANES && told(task.began) && (told(task.ended) ? task.ended : now) >= start) seen.push([task, lane]);
    }
    for (const [task, lane] of seen.slice(-MOST_BARS)) {
      const left = ((Math.max(task.began, start) - start) / span) * WIDTH;
      const right = (((told(task.ended) ? task.ended : now) - start) / span) * WIDTH;
      let bar = this.bars.get(task.id);
      if (!bar) this.bars.set(task.id, (bar = svg("rect", { height: LANE - 2, rx: 1 })));
      setAttribute(bar, "x", left.toFixed(1));
      setAttribute(bar, "width", Math.max(right - left, 1.5).toFixed(1));
      setAttribute(bar, "y", lane * LANE + 1);
      setAttribute(bar, "data-state", task.state);
      nodes.push(bar);
    }
    if (this.bars.size > nodes.length) {
      const kept = new Set(nodes);
      for (const [id, bar] of this.bars) if (!kept.has(bar)) this.bars.delete(id);
    }
    arrange(this.strip, nodes);
  }
}
