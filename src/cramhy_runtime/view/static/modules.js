// Process modules: what each executes, and what waits in its queue.

import { arrange, el, setAttribute, setText } from "./dom.js";
import { grouped } from "./format.js";
import { t } from "./texts.js";

const MOST_QUEUED = 8;

export class ModulesView {
  constructor({ list }) {
    this.list = list;
    this.rows = new Map(); // name → row
    this.empty = el("li", { class: "nothing" }, t("No process module is running."));
  }

  render(state) {
    const { modules } = state;
    const names = new Set(modules.map(({ name }) => name));
    for (const name of this.rows.keys()) if (!names.has(name)) this.rows.delete(name);
    arrange(this.list, modules.length ? modules.map((module) => this.#row(module)) : [this.empty]);
  }

  #row(module) {
    let row = this.rows.get(module.name);
    if (!row) this.rows.set(module.name, (row = newRow()));
    if (row.module === module) return row.node;
    row.module = module;
    row.node.dataset.state = module.state;
    setText(row.name, module.name);
    setAttribute(row.name, "title", module.name);
    setText(row.state, module.state.toLowerCase());
    setText(row.executes, module.executes || t("executes nothing"));
    row.executes.classList.toggle("idle", !module.executes);
    const shown = module.queue.slice(0, MOST_QUEUED);
    const rest = module.queue.length - shown.length;
    setAttribute(row.queue, "hidden", module.queue.length ? null : "");
    row.queue.replaceChildren(...shown.map((text) => el("li", {}, text)));
    if (rest) row.queue.append(el("li", { class: "rest" }, rest === 1 ? t("1 request more") : t("{count} requests more", { count: grouped(rest) })));
    return row.node;
  }
}

function newRow() {
  const [name, state, executes] = ["name", "state", "executes"].map((kind) => el("span", { class: kind }));
  const queue = el("ol", { class: "queue", "aria-label": t("waits in its queue") });
  return { node: el("li", { class: "module" }, el("p", {}, name, state), executes, queue), name, state, executes, queue };
}
