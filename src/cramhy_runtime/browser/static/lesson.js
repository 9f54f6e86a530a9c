// The lesson: pages of text, code to type, and tasks with hints and a check. `course.json` has them, as the room `course` tells them; see
// `cramhy_runtime.course.as_json`. What was read and solved is kept in the browser.
//
// A page is written for a session that begins with it: its turtle stands in the middle, and a package that the user writes on other pages has
// the name of one that comes with the course. So the session belongs to the page on which something was typed last, and another page's first
// button begins a new one. Those who only look at another page lose nothing, and neither do those who type there by hand.
//
// The prompt speaks the language of the lesson from its first line on. What is typed for that belongs to no page.

import { byId, el, setText } from "./dom.js";
import { keep, kept } from "./settings.js";
import { tab } from "./tab.js";
import { t } from "./texts.js";

const PROGRESS = "course";
const LOADS = 60_000; // ms within which a task's file is loaded

export class Lesson {
  // code: the `Code`, into which texts go. show(name): bring a part of the page into sight.
  constructor({ code, show }) {
    Object.assign(this, { code, show, pages: [], number: 0, hints: new Map(), tellings: new Map() });
    this.progress = remembered();
    this.owner = this.settled = null; // the page to which the session belongs, and for which page and language its files are there
    this.led = 0; // prompts that came since the lesson led to its language
    this.leads = true; // whether the next prompt is to be that of the language of the lesson
    this.seen = this.#prompts; // prompts that there had been when the user turned to this page
    tab.on("prompt", () => this.#prompt());
    tab.on("anew", () => Object.assign(this, { leads: true, leading: false }));
    byId("lesson-before").addEventListener("click", () => this.turn(this.number - 1));
    byId("lesson-after").addEventListener("click", () => this.turn(this.number + 1));
    byId("lesson-pages").addEventListener("change", ({ target }) => this.turn(target.selectedIndex));
    for (const button of byId("lesson-languages").querySelectorAll("button")) {
      button.addEventListener("click", () => this.speak(button.dataset.language));
    }
  }

  // Fetch the course. Without one there is no lesson, and the page has more room.
  async begin() {
    const answer = await fetch("course.json");
    this.pages = answer.ok ? (await answer.json()).pages : [];
    document.body.classList.toggle("no-lesson", !this.pages.length);
    if (!this.pages.length) return;
    byId("lesson-pages").replaceChildren(...this.pages.map(({ title }) => el("option", {}, title)));
    this.speak(this.progress.language);
    this.turn(Math.max(0, this.pages.findIndex(({ name }) => name === this.progress.page)));
  }

  turn(number) {
    if (!this.pages[number]) return;
    this.#note();
    this.number = number;
    this.seen = this.#prompts;
    this.progress.page = this.pages[number].name;
    this.#remember();
    this.render();
    byId("lesson-page").scrollTop = 0;
  }

  speak(language) {
    this.progress.language = language;
    this.#remember();
    for (const button of byId("lesson-languages").querySelectorAll("button")) {
      button.setAttribute("aria-pressed", String(button.dataset.language === language));
    }
    this.render();
    this.leads = true;
    this.#lead();
  }

  render() {
    const page = this.pages[this.number];
    if (!page) return;
    byId("lesson-page").dataset.language = this.progress.language; // hides what is for the other one
    byId("lesson-pages").selectedIndex = this.number;
    byId("lesson-before").disabled = this.number === 0;
    byId("lesson-after").disabled = this.number === this.pages.length - 1;
    const tasks = this.pages.flatMap(({ parts }) => parts.filter(({ kind }) => kind === "task"));
    const done = tasks.filter(({ name }) => this.progress.done.includes(name)).length;
    setText(byId("lesson-done"), tasks.length ? `${done}/${tasks.length}` : "");
    byId("lesson-done").title = t("{done} of {all} tasks are solved", { done, all: tasks.length });
    const kinds = {
      text: (part) => marked("div", part.html, "text"),
      code: (part) => this.#code(part),
      file: (part) => this.#file(part),
      task: (part) => this.#task(part),
    };
    const parts = page.parts.map((part) => kinds[part.kind](part)).filter(Boolean);
    byId("lesson-page").replaceChildren(el("h2", {}, page.title), ...this.#anew(), ...parts);
  }

  // ------------------------------------------------------------------------------------------------ the session and the pages

  // The prompts that there have been, without those that came of a change of language.
  get #prompts() {
    return tab.prompts - this.led;
  }

  #prompt() {
    if (this.leading) this.led++;
    this.leading = false;
    this.#lead();
  }

  // Let the prompt be that of the language of the lesson, once it waits for a form. In the debugger it waits for a choice.
  #lead() {
    if (!this.leads || !this.pages.length || tab.state !== "waits" || /^\d+\] /.test(tab.prompt.text)) return;
    this.leads = false;
    this.leading = tab.lead(this.progress.language);
  }

  // Where something was typed since the user turned to this page, the session belongs to it. The first prompt of all comes by itself.
  #note() {
    if (this.#prompts > Math.max(this.seen, 1)) this.owner = this.pages[this.number].name;
  }

  // A button that begins a session for this page, if that which is there belongs to another one.
  #anew() {
    if (!this.owner || this.owner === this.pages[this.number].name) return [];
    const { title } = this.pages.find(({ name }) => name === this.owner);
    const begin = () => this.#claim().catch((problem) => this.code.files.fail(problem));
    return [
      el(
        "div",
        { class: "choices" },
        el("span", {}, t("The session is that of the page “{title}”.", { title })),
        el("button", { type: "button", class: "chip", on: { click: begin } }, t("Begin this page anew")),
      ),
    ];
  }

  // Let the session be that of this page, and let the files of the pages before it be there.
  async #claim() {
    this.#note();
    const { language } = this.progress;
    const { name } = this.pages[this.number];
    const before = tab.prompts;
    const other = this.owner && this.owner !== name;
    this.owner = name;
    if (other) {
      this.settled = null;
      tab.restart(t("This page begins a new session. What was defined is gone; files are kept."));
      this.render();
    }
    if (other || this.leading || !before) await this.#prompted(before);
    if (this.settled === `${name} ${language}`) return;
    this.settled = `${name} ${language}`;
    await tab.ask("page", { page: name, language });
  }

  // ----------------------------------------------------------------------------------------------------------------- parts

  // Nothing where there is nothing to type in the chosen language.
  #code(part) {
    const { language } = this.progress;
    const text = part[language];
    const answer = language === "hy" ? part.answer_hy : part.answer;
    if (!text) return null;
    return el(
      "figure",
      { class: "sample" },
      el("pre", {}, el("code", {}, text)),
      el(
        "div",
        { class: "choices" },
        el("button", { type: "button", class: "chip", on: { click: () => this.#type(text, language) } }, t("Type it for me")),
        el("button", { type: "button", class: "chip", on: { click: () => this.#copy(text, language) } }, t("Copy into the editor")),
        answer ? el("details", {}, el("summary", {}, t("Answer")), el("pre", {}, answer.replace(/^\n+|\n$/g, ""))) : null,
      ),
    );
  }

  #file(part) {
    const file = part[this.progress.language];
    if (!file) return null;
    return el(
      "figure",
      { class: "sample" },
      el("figcaption", {}, t("File"), " ", el("code", {}, file.name)),
      el("pre", {}, el("code", {}, file.text)),
      el(
        "div",
        { class: "choices" },
        el("button", { type: "button", class: "chip", on: { click: () => this.#write(file) } }, t("Write it for me")),
      ),
    );
  }

  async #write({ name, text }) {
    try {
      await this.code.write(name, text);
    } catch (problem) {
      this.code.files.fail(problem);
    }
  }

  async #type(text, language) {
    this.show("repl");
    try {
      await this.#claim();
      tab.run(text, { language });
    } catch (problem) {
      this.code.files.fail(problem);
    }
  }

  async #copy(text, language) {
    const { editor, files } = this.code;
    this.show("code");
    await files.there;
    const suffix = language === "hy" ? ".hy" : ".lisp";
    if (!files.path.endsWith(suffix)) await files.add(`${this.pages[this.number].name}${suffix}`, "");
    editor.cursor = editor.text.length;
    editor.insert(`${editor.text.trim() ? "\n\n" : ""}${text}\n`);
    editor.focus();
  }

  #task(part) {
    const { language } = this.progress;
    const start = part.start?.[language];
    const file = `${part.name}${language === "hy" ? ".hy" : ".lisp"}`;
    const told = this.tellings.get(part.name) ?? el("div", { class: "told", role: "status" });
    this.tellings.set(part.name, told);
    const done = this.progress.done.includes(part.name);
    const section = el("section", { class: `task-box${done ? " done" : ""}`, "aria-label": t("Task") });
    const check = el("button", { type: "button", class: "chip main" }, t("Check"));
    check.addEventListener("click", () => this.#check(part, start ? file : null, language, check, told));
    section.append(
      el("p", { class: "kind" }, done ? t("Task, solved") : t("Task"), part.title ? `: ${part.title}` : ""),
      marked("div", part.html, "text"),
      el(
        "div",
        { class: "choices" },
        start ? el("button", { type: "button", class: "chip", on: { click: () => this.#open(file, start) } }, t("Open in the editor")) : "",
        check,
      ),
      ...this.#hints(part),
      told,
    );
    return section;
  }

  #open(file, start) {
    this.code.put(file, start, { resume: true }).catch((problem) => this.code.files.fail(problem));
  }

  #hints({ name, hints = [] }) {
    if (!hints.length) return [];
    const list = el("ol", { class: "hints" });
    const button = el("button", { type: "button", class: "chip" });
    const render = () => {
      const shown = this.hints.get(name) ?? 0;
      list.replaceChildren(...hints.slice(0, shown).map((hint) => marked("li", hint)));
      button.hidden = shown === hints.length;
      setText(button, t("Hint {number} of {all}", { number: shown + 1, all: hints.length }));
    };
    button.addEventListener("click", () => {
      this.hints.set(name, (this.hints.get(name) ?? 0) + 1);
      render();
    });
    render();
    return [list, button];
  }

  // Load the file of a task, if it has one, and have the session checked.
  async #check({ name }, file, language, button, told) {
    button.disabled = true;
    told.className = "told";
    told.replaceChildren(t("checking …"));
    try {
      await this.#claim();
      if (file) await this.#load(file);
      const { passed, told: texts } = await tab.ask("check", { task: name, language });
      told.className = `told ${passed ? "passed" : "missed"}`;
      told.replaceChildren(el("p", {}, passed ? t("Solved.") : t("Not yet.")), el("ul", {}, ...texts.map((text) => el("li", {}, text))));
      if (passed && !this.progress.done.includes(name)) {
        this.progress.done.push(name);
        this.#remember();
        this.render();
      }
    } catch (problem) {
      told.className = "told missed";
      told.replaceChildren(problem.message);
    }
    button.disabled = false;
  }

  async #load(file) {
    const { files, editor } = this.code;
    await files.there;
    await files.save();
    if (!files.paths.includes(file)) return; // it was solved at the prompt
    if (tab.state !== "waits") throw new Error(t("A form runs still. Wait until it has ended, or stop it, and check again."));
    const text = files.path === file ? editor.text : await tab.file("read", { path: file });
    const before = tab.prompts;
    if (file.endsWith(".hy")) tab.run(text, { language: "hy" });
    else tab.run(`(load "${file}")`);
    await this.#prompted(before);
    if (!byId("debugger").hidden) throw new Error(t("{file} cannot be loaded. The prompt shows why.", { file }));
  }

  #prompted(before) {
    const end = performance.now() + LOADS;
    return new Promise((resolve, reject) => {
      const look = () => {
        if (tab.prompts > before && tab.state === "waits") resolve();
        else if (performance.now() > end) reject(new Error(t("It has not ended after a minute. Stop it, and look for a loop.")));
        else setTimeout(look, 50);
      };
      look();
    });
  }

  #remember() {
    keep(PROGRESS, JSON.stringify(this.progress));
  }
}

// An element with markup of the course's own.
function marked(tag, html, name = "") {
  const node = el(tag, name ? { class: name } : {});
  const made = new DOMParser().parseFromString(html, "text/html");
  for (const link of made.querySelectorAll("a[href]")) Object.assign(link, { target: "_blank", rel: "noopener" });
  node.append(...made.body.childNodes);
  return node;
}

function remembered() {
  const fresh = { page: "", language: "lisp", done: [] };
  try {
    const found = JSON.parse(kept(PROGRESS, "{}"));
    return { ...fresh, ...found, done: Array.isArray(found.done) ? found.done : [] };
  } catch {
    return fresh;
  }
}
