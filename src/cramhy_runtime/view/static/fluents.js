// Fluents with their values, and the recent past of each as a step line. Those that process modules make for themselves are shown when
// somebody asks.

import { arrange, el, setAttribute, setText, svg } from "./dom.js";
import { Series, WINDOW, numberOf } from "./series.js";
import { t } from "./texts.js";

const MOST = 80; // rows; of more, the ones that changed last
const WIDTH = 120;
const HEIGHT = 22;

export class FluentsView {
  constructor({ list, count }) {
    Object.assign(this, { list, count });
    this.rows = new Map(); // id → row
    this.live = new Map(); // id → Series
    this.touched = new Map(); // id → stamp of the last change
    this.past = { state: null }; // the moment that is looked back at, with what was found out about the time before it
    this.all = false; // whether those are shown that the program did not make itself
    this.empty = el("li", { class: "nothing" });
  }

  forget() {
    this.live.clear();
    this.touched.clear();
  }

  // A Fluents message of the live session.
  note({ stamp, fluents, complete, removed }) {
    record(this.live, this.touched, stamp, fluents);
    const kept = complete && new Set(fluents.map(({ id }) => id));
    for (const id of complete ? [...this.touched.keys()].filter((one) => !kept.has(one)) : removed ?? []) {
      this.live.delete(id);
      this.touched.delete(id);
    }
  }

  // history: null for the live session, else the History from which the lines before `now` are drawn, once for each `state`.
  render(state, now, history) {
    const { series, touched } = history ? this.#past(history, state, now) : { series: this.live, touched: this.touched };
    let fluents = [...state.fluents.values()];
    const known = fluents.length;
    if (!this.all) fluents = fluents.filter(({ internal }) => !internal);
    setText(this.count, known ? (fluents.length < known ? `${fluents.length} of ${known}` : String(known)) : "");
    setText(this.empty, known ? t("The program has made no fluent. Process modules have.") : t("No fluent yet."));
    const shown = new Set(fluents.map(({ id }) => id));
    if (fluents.length > MOST) {
      const latest = new Set([...fluents].sort((one, other) => (touched.get(other.id) ?? 0) - (touched.get(one.id) ?? 0)).slice(0, MOST));
      fluents = fluents.filter((fluent) => latest.has(fluent));
    }
    for (const id of this.rows.keys()) if (!shown.has(id)) this.rows.delete(id);
    const nodes = fluents.map((fluent) => this.#row(fluent, series.get(fluent.id), now, touched.get(fluent.id)));
    arrange(this.list, nodes.length ? nodes : [this.empty]);
  }

  #past(history, state, now) {
    if (this.past.state === state) return this.past;
    const series = new Map();
    const touched = new Map();
    const before = history.at(now - WINDOW);
    record(series, touched, before.stamp, before.fluents.values());
    for (const { message } of history.between("fluents", now - WINDOW, now)) record(series, touched, message.stamp, message.fluents);
    this.past = { state, series, touched };
    return this.past;
  }

  #row(fluent, series, now, changed) {
    let row = this.rows.get(fluent.id);
    if (!row) this.rows.set(fluent.id, (row = newRow()));
    setText(row.name, fluent.name);
    setAttribute(row.name, "title", fluent.name);
    setText(row.value, fluent.value);
    row.node.classList.toggle("fresh", changed != null && now - changed < 0.6);
    const d = series?.path(now, WIDTH, HEIGHT) ?? "";
    if (row.d !== d) {
      row.line.setAttribute("d", (row.d = d));
      row.node.classList.toggle("drawn", d !== "");
    }
    return row.node;
  }
}

function record(series, touched, stamp, fluents) {
  for (const fluent of fluents) {
    touched.set(fluent.id, stamp);
    const number = numberOf(fluent);
    if (number === null) {
      series.delete(fluent.id); // a line has no place for what is no number
      continue;
    }
    if (!series.has(fluent.id)) series.set(fluent.id, new Series());
    series.get(fluent.id).push(stamp, number);
  }
}

function newRow() {
  const name = el("span", { class: "name" });
  const value = el("span", { class: "value" });
  const line = svg("path");
  const box = `-1 -2 ${WIDTH + 2} ${HEIGHT + 4}`;
  const spark = svg("svg", { class: "spark", viewBox: box, preserveAspectRatio: "none", "aria-hidden": "true" }, line);
  return { node: el("li", { class: "fluent" }, name, spark, value), name, value, line };
}
