// The lines of /rosout. New ones come at the end and stay in sight as long as nobody scrolls up; the oldest are given up.

import { el } from "./dom.js";

const MOST = 600;
const BURST = 120; // lines drawn at once; of more, the last
const LEVELS = [[16, "fatal"], [8, "error"], [4, "warn"], [2, "info"], [1, "debug"]];
const levelOf = (number) => LEVELS.find(([least]) => number >= least)?.[1] ?? "debug";

export class LogView {
  // The element that scrolls and the list in it; the choice of the least level.
  constructor({ scroller, list, level }) {
    Object.assign(this, { scroller, list });
    this.lines = []; // {stamp of plan time, level, name, msg, node}
    this.fresh = [];
    this.least = Number(level.value);
    this.until = Infinity;
    level.addEventListener("change", () => {
      this.least = Number(level.value);
      this.#filter();
    });
  }

  // A rosgraph_msgs/Log message that came at `stamp` of plan time.
  add({ level, name, msg }, stamp) {
    this.fresh.push({ stamp, level, name, msg });
    if (this.fresh.length > MOST) this.fresh.splice(0, this.fresh.length - MOST);
  }

  // A recording was put to another time: what was said until then is not known, but for what is told after this.
  forget() {
    this.fresh = [];
    this.lines = [];
    this.list.replaceChildren();
  }

  // Show the lines until the time `until`; Infinity for all.
  render(until) {
    const { scroller, list } = this;
    if (until !== this.until) {
      this.until = until;
      this.#filter();
    }
    if (!this.fresh.length) return;
    const atEnd = scroller.scrollHeight - scroller.scrollTop - scroller.clientHeight < 24;
    const lines = this.fresh.splice(0, BURST);
    for (const line of lines) {
      line.node = row(line);
      line.node.hidden = !this.#visible(line);
    }
    list.append(...lines.map(({ node }) => node));
    this.lines.push(...lines);
    while (this.lines.length > MOST) this.lines.shift().node.remove();
    if (atEnd) scroller.scrollTop = scroller.scrollHeight;
  }

  #visible(line) {
    return line.level >= this.least && line.stamp <= this.until;
  }

  #filter() {
    for (const line of this.lines) line.node.hidden = !this.#visible(line);
    this.scroller.scrollTop = this.scroller.scrollHeight;
  }
}

function row({ level, name, msg }) {
  const kind = levelOf(level);
  return el("li", { class: `line ${kind}` },
    el("span", { class: "kind" }, kind), el("span", { class: "node" }, name), el("span", { class: "text" }, msg));
}
