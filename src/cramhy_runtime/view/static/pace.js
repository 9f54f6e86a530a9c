// How plan time passes: pause, one step, speed. Only virtual time can be held; the wall's cannot, and then the controls say so.

import { setAttribute, setText } from "./dom.js";
import { t } from "./texts.js";

const WALL = t("Time is the wall's in this session. It can be paused, stepped and sped up in one that was started with --time virtual.");

export class PaceView {
  // call(service, arguments) asks the session; failed(error) tells the user.
  constructor({ pause, step, size, speed, call, failed }) {
    Object.assign(this, { pause, step, size, speed, call, failed });
    this.pace = null;
    this.wanted = {}; // what was asked for and is not answered yet
    this.open = 0; // questions without an answer
    pause.addEventListener("click", () => this.#set({ paused: !this.pace?.paused }));
    speed.addEventListener("change", () => this.#set({ speed: Number(speed.value) }));
    step.addEventListener("click", () => this.#ask("/cramhy/step", { seconds: Number(size.value) }));
  }

  // The Pace of the live session, null while there is none.
  render(pace) {
    if (pace === this.pace) return;
    this.pace = pace;
    const held = Boolean(pace) && (pace.virtual || Boolean(pace.recording));
    for (const control of [this.pause, this.step, this.size, this.speed]) {
      control.disabled = !held;
      setAttribute(control, "title", pace && !held ? WALL : null);
    }
    setText(this.pause, pace?.paused ? t("Resume") : t("Pause"));
    setAttribute(this.pause, "aria-pressed", String(Boolean(pace?.paused)));
    if (pace) this.#select(pace.speed);
  }

  #select(speed) {
    const value = String(speed);
    if (![...this.speed.options].some((option) => option.value === value)) this.speed.add(new Option(`× ${speed}`, value));
    this.speed.value = value;
  }

  #set(change) {
    const { paused = false, speed = 1 } = this.pace ?? {};
    Object.assign(this.wanted, change);
    return this.#ask("/cramhy/set_pace", { paused, speed, ...this.wanted });
  }

  async #ask(service, args) {
    this.open++;
    try {
      const { pace } = await this.call(service, args);
      if (pace) this.render(pace);
    } catch (error) {
      this.failed(error);
      const { pace } = this;
      this.pace = undefined;
      this.render(pace); // what was chosen did not come true
    } finally {
      if (--this.open === 0) this.wanted = {};
    }
  }
}
