// The task tree: what every task of the plans does, since when, what it waits for and where in the text. One line per task, kept
// from one look to the next, so that only what has changed is touched. It is an ARIA tree: one stop for the tabulator, arrow keys within.
// What runs now is marked and kept in sight, until somebody scrolls or walks in the tree; the button brings that back.

import { arrange, el, setAttribute, setText, svg } from "./dom.js";
import { duration, grouped, shortName } from "./format.js";
import { alive, foremost, outline } from "./outline.js";
import { told } from "./state.js";
import { t } from "./texts.js";

const MARKS = {
  CREATED: "M6 5.2a.8.8 0 1 0 .01 0z",
  RUNNING: "M3.5 2.5v7l6-3.5z",
  WAITING: "M6 1.8a4.2 4.2 0 1 0 .01 0zM6 3.8V6l1.6 1",
  SUSPENDED: "M4.2 2.8v6.4M7.8 2.8v6.4",
  SUCCEEDED: "M2.2 6.4 5 9l4.8-6",
  FAILED: "M2.8 2.8l6.4 6.4M9.2 2.8 2.8 9.2",
  EVAPORATED: "M3 6h6",
};

export class TreeView {
  constructor({ tree, none, count, follow }) {
    Object.assign(this, { tree, none, count, follow });
    this.rows = new Map(); // key → row
    this.choices = new Map();
    this.wide = new Set();
    this.shown = [];
    this.current = null; // key of the row that has the tabulator's stop
    this.now = null; // the row of what runs now
    tree.addEventListener("keydown", (event) => this.#key(event));
    tree.addEventListener("click", (event) => this.#click(event));
    tree.addEventListener("focusin", ({ target }) => this.#stop(target.closest("[role=treeitem]")?.dataset.key));
    for (const way of ["wheel", "touchmove", "pointerdown", "focusin"]) tree.addEventListener(way, () => this.#follow(false), { passive: true });
    follow.addEventListener("click", () => this.#follow(!this.follows));
    this.#follow(true);
  }

  // Another session begins: its tasks have nothing to do with those of before, though they be numbered alike.
  forget() {
    this.choices.clear();
    this.wide.clear();
  }

  // state: a State. now: plan time, s.
  render(state, now) {
    this.state = state;
    this.time = now;
    const rows = (this.shown = outline(state.tasks, this.choices, this.wide));
    const keys = new Set(rows.map(({ key }) => key));
    const focused = this.tree.contains(document.activeElement);
    for (const key of this.rows.keys()) if (!keys.has(key)) this.rows.delete(key);
    if (!keys.has(this.current)) this.current = rows[0]?.key ?? null;
    arrange(this.tree, rows.map((row) => this.#row(row).node));
    this.tree.hidden = !rows.length;
    this.none.hidden = rows.length > 0;
    if (focused && !this.tree.contains(document.activeElement)) this.rows.get(this.current)?.node.focus({ preventScroll: true });
    let running = 0;
    for (const task of state.tasks.values()) running += alive(task);
    setText(this.count, state.tasks.size ? t("{alive} alive, {ended} ended", { alive: running, ended: state.tasks.size - running }) : "");
    this.now = foremost(rows) ?? null;
    if (this.follows) this.#show();
  }

  // What runs now, in a few words; "" when nothing does.
  get running() {
    return this.now ? shortName(this.now.task.name) : "";
  }

  #follow(on) {
    this.follows = on;
    setAttribute(this.follow, "aria-pressed", String(on));
    if (on) this.#show();
  }

  // Scroll as little as is needed to have what runs now in sight.
  #show() {
    const node = this.now && this.rows.get(this.now.key)?.node;
    if (!node) return;
    const { tree } = this;
    const [top, bottom] = [node.offsetTop, node.offsetTop + node.offsetHeight];
    if (top < tree.scrollTop) tree.scrollTop = top;
    else if (bottom > tree.scrollTop + tree.clientHeight) tree.scrollTop = bottom - tree.clientHeight;
  }

  #row(row) {
    let known = this.rows.get(row.key);
    if (!known) this.rows.set(row.key, (known = row.task ? taskRow(row.key) : moreRow(row.key)));
    const { node } = known;
    setAttribute(node, "aria-level", row.level);
    setAttribute(node, "tabindex", row.key === this.current ? "0" : "-1");
    if (known.level !== row.level) {
      known.level = row.level;
      node.style.setProperty("--level", Math.min(row.level - 1, 12));
    }
    setAttribute(node, "aria-posinset", row.index);
    setAttribute(node, "aria-setsize", row.of);
    if (row.task) this.#fill(known, row);
    else {
      setText(known.text, row.hidden === 1 ? t("1 task more that ended") : t("{count} tasks more that ended", { count: grouped(row.hidden) }));
      setAttribute(node, "aria-expanded", String(row.open));
    }
    return known;
  }

  #fill(known, { task, children, open, now }) {
    const { node, name, operator, waits, place, time } = known;
    setAttribute(node, "aria-expanded", children ? String(open) : null);
    setAttribute(node, "aria-current", now ? "true" : null);
    if (known.task !== task) {
      known.task = task;
      const doing = stateOf(task);
      if (node.dataset.state !== doing) {
        node.dataset.state = doing;
        known.mark.setAttribute("d", MARKS[doing] ?? MARKS.CREATED);
        setText(known.state, doing.toLowerCase());
      }
      setText(name, shortName(task.name));
      setAttribute(name, "title", task.name);
      setText(operator, task.operator && !task.name.includes(task.operator) ? task.operator.toLowerCase() : "");
      setText(waits, remark(task));
      setAttribute(waits, "title", remark(task) || null);
      setText(place, task.place.replace(/^.*[/\\]/, ""));
      setAttribute(place, "title", task.place || null);
    }
    setText(time, told(task.began) ? duration(Math.max(0, (told(task.ended) ? task.ended : this.time) - task.began)) : "");
  }

  #click(event) {
    const key = event.target.closest("[role=treeitem]")?.dataset.key;
    if (key == null) return;
    this.#stop(key);
    this.rows.get(key).node.focus({ preventScroll: true });
    this.#toggle(key);
  }

  #toggle(key, open) {
    const row = this.shown.find((one) => one.key === key);
    if (!row) return;
    const opens = open ?? !row.open;
    if (row.hidden && opens) this.wide.add(row.parent);
    else if (row.hidden) this.wide.delete(row.parent);
    else if (row.children) this.choices.set(key, opens);
    this.render(this.state, this.time);
  }

  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const at = this.shown.findIndex(({ key }) => key === this.current);
    const row = this.shown[at];
    if (!row) return;
    const above = this.shown.findLastIndex((one, place) => place < at && one.level < row.level);
    const actions = {
      ArrowDown: () => this.#go(at + 1),
      ArrowUp: () => this.#go(at - 1),
      Home: () => this.#go(0),
      End: () => this.#go(this.shown.length - 1),
      ArrowRight: () => (row.open ? this.#go(at + 1) : this.#toggle(row.key, true)),
      ArrowLeft: () => (row.open ? this.#toggle(row.key, false) : this.#go(above)),
      Escape: () => this.#follow(true),
      Enter: () => this.#toggle(row.key),
      " ": () => this.#toggle(row.key),
    };
    if (!actions[event.key] || (event.key === "Escape" && this.follows)) return;
    event.preventDefault();
    actions[event.key]();
  }

  #go(index) {
    const row = this.shown[index];
    if (!row) return;
    this.#stop(row.key);
    const { node } = this.rows.get(row.key);
    node.focus();
    node.scrollIntoView({ block: "nearest" });
  }

  #stop(key) {
    if (key == null || key === this.current) return;
    const before = this.rows.get(this.current)?.node;
    if (before) setAttribute(before, "tabindex", "-1");
    this.current = key;
    const node = this.rows.get(key)?.node;
    if (node) setAttribute(node, "tabindex", "0");
  }
}

// The original has a state WAITING that it never gives; here a task that runs and waits for something is shown as one that waits.
const stateOf = (task) => (task.state === "RUNNING" && task.waits_for ? "WAITING" : task.state);

// What a task is about now: what it waits for while it lives, what became of it after.
function remark(task) {
  if (alive(task)) return task.waits_for ? t("waits for {what}", { what: task.waits_for }) : "";
  return task.result ? task.state === "FAILED" ? t("failed with {what}", { what: task.result }) : t("gave {what}", { what: task.result }) : "";
}

function taskRow(key) {
  const kinds = ["unseen", "name", "operator", "waits", "place", "time"];
  const [state, name, operator, waits, place, time] = kinds.map((kind) => el("span", { class: kind }));
  const mark = svg("path");
  const node = el("div", { role: "treeitem", class: "task" },
    el("span", { class: "twist", "aria-hidden": "true" }),
    svg("svg", { class: "mark", viewBox: "0 0 12 12", "aria-hidden": "true" }, mark),
    el("span", { class: "title" }, name, state, operator), time, el("span", { class: "more" }, waits, place));
  node.dataset.key = key;
  return { node, mark, state, name, operator, waits, place, time };
}

function moreRow(key) {
  const text = el("span", { class: "text" });
  const node = el("div", { role: "treeitem", class: "task rest" }, el("span", { class: "twist", "aria-hidden": "true" }), text);
  node.dataset.key = key;
  return { node, text };
}
