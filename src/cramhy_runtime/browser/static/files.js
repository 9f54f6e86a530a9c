// The files of the user in the editor: which there are, the one that is open, and that what is typed is saved by itself.

import { keepDraft, dropDraft, drafts } from "./drafts.js";
import { el } from "./dom.js";
import { keep, kept } from "./settings.js";
import { tab } from "./tab.js";
import { t } from "./texts.js";

const PAUSE = 400; // ms without a key, after which a file is saved
const FIRST = "plans.lisp";

const languageOf = (path) => (/\.(lisp|lsp|cl|asd)$/.test(path) ? "lisp" : path.endsWith(".hy") ? "hy" : "text");

export class Files {
  // chooser: the select in which the files stand. editor: the `Editor`. say(text): a note for the user.
  constructor({ chooser, editor, say }) {
    Object.assign(this, { chooser, editor, say, path: null, saved: null, timer: null, paths: [], states: new Map() });
    this.there = new Promise((resolve) => (this.arrived = resolve));
    chooser.addEventListener("change", () => this.open(chooser.value).catch((problem) => this.fail(problem)));
    tab.on("files", () => this.#begin());
    tab.on("prompt", () => this.refresh().catch(() => {})); // a form may have written some
    for (const event of ["pagehide", "blur"]) window.addEventListener(event, () => this.#changed && keepDraft(this.path, editor.text));
  }

  get #changed() {
    return this.path !== null && this.editor.text !== this.saved;
  }

  fail(problem) {
    this.say(problem.message, "bad");
  }

  // Python's files are there, for the first time or after a restart.
  async #begin() {
    try {
      for (const [path, text] of drafts()) {
        await tab.file("write", { path, text });
        dropDraft(path, text);
        if (path === this.path) this.saved = text;
      }
      await this.refresh();
      if (this.path === null) {
        const wanted = kept("file", FIRST);
        await this.open(this.paths.includes(wanted) ? wanted : (this.paths.find((path) => languageOf(path) !== "text") ?? FIRST));
      } else if (this.#changed) await this.save();
      this.arrived();
    } catch (problem) {
      this.fail(problem);
    }
  }

  async refresh() {
    this.paths = await tab.file("list");
    const shown = this.path !== null && !this.paths.includes(this.path) ? [...this.paths, this.path].sort() : this.paths;
    const options = shown.map((path) => el("option", { value: path }, path));
    if (options.map(({ value }) => value).join("\n") !== [...this.chooser.options].map(({ value }) => value).join("\n")) {
      this.chooser.replaceChildren(...options);
    }
    if (this.path !== null) this.chooser.value = this.path;
  }

  // Show the file PATH, a new one where there is none.
  async open(path) {
    await this.save();
    const text = this.paths.includes(path) ? await tab.file("read", { path }) : "";
    if (text === null) {
      await this.refresh();
      return this.say(t("{path} is no text, so it is not shown here.", { path }), "bad");
    }
    if (this.path !== null) this.states.set(this.path, this.editor.leave());
    this.path = path;
    this.saved = text;
    this.editor.open(text, languageOf(path), this.states.get(path));
    keep("file", path);
    await this.refresh();
    return this.say("");
  }

  // The user has typed.
  touch() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.save().catch((problem) => this.fail(problem)), PAUSE);
  }

  // Promises that the folder has what is in the editor.
  async save() {
    clearTimeout(this.timer);
    if (!this.#changed) return;
    const { path } = this;
    const { text } = this.editor;
    keepDraft(path, text);
    this.saved = text;
    const lasting = await tab.file("write", { path, text });
    if (lasting) dropDraft(path, text);
    if (!this.paths.includes(path)) await this.refresh();
  }

  // Put a file there and show it. A file of that name with another text stays; the new one gets another name.
  async add(path, text) {
    await this.there;
    await this.refresh();
    const free = await this.#nameFor(path, text);
    if (!this.paths.includes(free)) {
      await tab.file("write", { path: free, text });
      await this.refresh();
    }
    await this.open(free);
    return free;
  }

  // Make TEXT the whole of a file, and show it.
  async write(path, text) {
    if (path === this.path) this.editor.text = text;
    else await tab.file("write", { path, text });
    await this.refresh();
    await this.open(path);
  }

  async #nameFor(path, text) {
    const [, stem, suffix] = /^(.*?)(\.[^./]*)?$/s.exec(path);
    for (let number = 1; ; number++) {
      const name = number === 1 ? path : `${stem}-${number}${suffix ?? ""}`;
      if (!this.paths.includes(name) || (await tab.file("read", { path: name })) === text) return name;
    }
  }

  async rename(to) {
    await this.save();
    if (!this.paths.includes(this.path)) await tab.file("write", { path: this.path, text: this.editor.text });
    await tab.file("rename", { path: this.path, to });
    dropDraft(this.path);
    this.path = to;
    this.editor.speak(languageOf(to));
    keep("file", to);
    await this.refresh();
  }

  async delete() {
    const { path } = this;
    clearTimeout(this.timer);
    dropDraft(path);
    if (this.paths.includes(path)) await tab.file("delete", { path });
    this.path = null;
    this.states.delete(path);
    this.paths = await tab.file("list");
    await this.open(this.paths.find((each) => languageOf(each) !== "text") ?? FIRST);
  }
}
