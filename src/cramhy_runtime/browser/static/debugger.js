// The debugger: a button for each way to go on, and the calls that led to the error. What is wrong stands in the transcript above. A button
// types the number of its restart at the prompt, where numbers and forms can be typed as well.

import { arrange, byId, el, setText } from "./dom.js";
import { tab } from "./tab.js";
import { t } from "./texts.js";

export class Debugger {
  constructor() {
    this.place = byId("debugger");
    tab.on("debug", (error) => this.show(error));
    tab.on("state", (state) => {
      for (const button of this.place.querySelectorAll("button.restart")) button.disabled = state !== "waits";
    });
  }

  show(error) {
    this.place.hidden = error === null;
    if (!error) return;
    const { level, type, restarts, frames } = error;
    setText(byId("debugger-title"), level ? t("{type}, level {level}", { type, level }) : type);
    arrange(byId("debugger-restarts"), restarts.map((restart, number) => this.#restart(restart, number)));
    byId("debugger-calls").hidden = !frames.length;
    arrange(byId("debugger-frames"), frames.map((frame) => this.#frame(frame)));
    this.place.scrollTop = 0;
  }

  #restart({ name, report }, number) {
    const button = el(
      "button",
      { type: "button", class: "restart", disabled: tab.state !== "waits", on: { click: () => tab.type(String(number)) } },
      el("span", { class: "number" }, String(number)),
      el("span", { class: "name" }, name),
      el("span", { class: "report" }, report),
    );
    return el("li", {}, button);
  }

  #frame({ call, place, variables }) {
    const head = [el("code", {}, call), " ", place ? el("span", { class: "place" }, place) : null];
    if (!variables.length) return el("li", {}, el("p", {}, ...head));
    const told = variables.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]);
    return el("li", {}, el("details", {}, el("summary", {}, ...head), el("dl", {}, ...told)));
  }
}
