// The editor of the page: its keys and buttons, its files, and how they leave and come back: as a package in a zip, and as a link.

import { Arguments, completer } from "./asking.js";
import { byId, setText } from "./dom.js";
import { ask } from "./dialog.js";
import { Editor } from "./editor.js";
import { Files } from "./files.js";
import { formAt, literal, surroundings, topStart } from "./forms.js";
import { packed, unpacked } from "./share.js";
import { kept, keep } from "./settings.js";
import { tab } from "./tab.js";
import { t } from "./texts.js";

const HELP =
  "Ctrl-C Ctrl-C or Alt-Enter evaluates the form at the cursor, Ctrl-C Ctrl-K loads the file, Tab completes, Escape and then Tab leaves.";
const CHORD = 1500; // ms between Ctrl-C and the key behind it
const MOST = 10_000_000; // bytes of a file that is imported

export class Code {
  // show(): bring the editor into sight.
  constructor({ show }) {
    this.show = show;
    this.chord = 0; // until when the key behind Ctrl-C is waited for
    const around = () => (this.editor.language === "text" ? { language: "text" } : this.#around(this.editor.cursor));
    const typed = (text) => text.slice(topStart(text, text.length));
    this.editor = new Editor({
      place: byId("code-place"),
      id: "code-in",
      label: t("File in the editor"),
      describedBy: t(HELP),
      numbers: true,
      complete: (text) => completer(around)(typed(text)),
      changed: () => this.files.touch(),
      moved: () => {
        const chosen = Boolean(this.editor?.chosen.text);
        setText(byId("code-form"), chosen ? t("Evaluate selection") : t("Evaluate form"));
        this.arguments?.look(typed(this.editor.text.slice(0, this.editor.cursor)), around());
      },
      keys: [
        { key: "Alt-Enter", run: () => this.evaluate() },
        { key: "Ctrl-c", run: () => this.#ctrlC() },
        { key: "Ctrl-k", run: () => this.#chordEnds(() => this.load()) },
        { key: "Ctrl-s", run: () => (this.files.save().catch((problem) => this.files.fail(problem)), true) },
      ],
    });
    this.arguments = new Arguments(byId("code-args"));
    this.files = new Files({ chooser: byId("code-file"), editor: this.editor, say: (...note) => this.say(...note) });
    const menu = byId("code-menu");
    menu.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !menu.open) return;
      event.preventDefault();
      menu.open = false;
      menu.querySelector("summary").focus();
    });
    document.addEventListener("pointerdown", (event) => {
      if (!menu.contains(event.target)) menu.open = false;
    });
    const { evaluate: form, load, new: fresh, rename, delete: remove, export: leave, import: take, share } = this;
    const actions = { form, load, new: fresh, rename, delete: remove, export: leave, import: take, share };
    for (const [name, act] of Object.entries(actions)) {
      byId(`code-${name}`).addEventListener("click", async () => {
        menu.open = false;
        try {
          await act.call(this);
        } catch (problem) {
          this.files.fail(problem);
        }
      });
    }
    byId("code-zip").addEventListener("change", ({ target }) => {
      const [file] = target.files;
      target.value = "";
      if (file) this.unpack(file).catch((problem) => this.files.fail(problem));
    });
    window.addEventListener("hashchange", () => this.openLink());
  }

  #around(place) {
    return surroundings(this.editor.text, place, this.files?.path ?? "");
  }

  // A note at the foot of the editor; kind: "bad" for what went wrong.
  say(text, kind = "") {
    byId("code-state").dataset.kind = kind;
    setText(byId("code-state"), t(text));
  }

  // ----------------------------------------------------------------------------------------------------------- evaluation

  // The text that is chosen, or else the form at the cursor.
  evaluate() {
    const { text: chosen, from } = this.editor.chosen;
    const form = chosen.trim() ? { text: chosen, start: from } : formAt(this.editor.text, this.editor.cursor);
    if (!form) this.say("No complete form stands at the cursor.", "bad");
    else {
      this.say("");
      this.files.save().catch((problem) => this.files.fail(problem)); // before it is evaluated: an error shows the line of the file
      const start = form.start + form.text.search(/\S/);
      tab.run(form.text.trim(), { ...this.#around(form.start), place: { path: this.files.path, ...this.editor.placeOf(start) } });
    }
    return true;
  }

  // The whole file. Plain Hy is evaluated at the prompt, since that is where its names are wanted.
  async load() {
    const { path } = this.files;
    await this.files.save();
    if (this.editor.language === "text") return this.say(t("{path} holds no program.", { path }), "bad");
    this.say("");
    const [folder, name] = ["", ...path.split("/")].slice(-2);
    if (path.endsWith(".hy") && this.#around(Infinity).language === "hy") tab.run(this.editor.text.trim(), { language: "hy" });
    else if (path.endsWith(".asd") && folder) tab.run(`(ros-load:load-system ${literal(folder)} :${name.replace(/\.asd$/, "")})`);
    else tab.run(`(load ${literal(path)})`);
    return true;
  }

  // As in SLIME: Ctrl-C Ctrl-C. With a choice, Ctrl-C copies it, as everywhere.
  #ctrlC() {
    if (this.editor.chosen.text) return false;
    const now = performance.now();
    if (now < this.chord) {
      this.chord = 0;
      return this.evaluate();
    }
    this.chord = now + CHORD;
    return true;
  }

  #chordEnds(act) {
    if (performance.now() >= this.chord) return false;
    this.chord = 0;
    act().catch((problem) => this.files.fail(problem));
    return true;
  }

  // ---------------------------------------------------------------------------------------------------------------- files

  async new() {
    const name = await ask({
      text: t("Name of the new file"),
      field: "",
      ok: t("Make it"),
      hint: t("A name that ends in .lisp is Common Lisp, one that ends in .hy is Hy."),
    });
    if (!name) return;
    const path = /\.[^/]*$/.test(name) ? name : `${name}.lisp`;
    await this.files.open(path);
    this.editor.focus();
  }

  async rename() {
    const name = await ask({ text: t("New name of {path}", { path: this.files.path }), field: this.files.path, ok: t("Rename") });
    if (name && name !== this.files.path) await this.files.rename(name);
  }

  async delete() {
    const { path } = this.files;
    if (await ask({ text: t("Delete {path}? It cannot be brought back.", { path }), ok: t("Delete") })) await this.files.delete();
  }

  // Open a text as a file, such as the beginning of a task. A file of that name with another text is shown as it is, if `resume`.
  async put(path, text, { resume = false } = {}) {
    this.show();
    await this.files.there;
    if (resume && this.files.paths.includes(path)) await this.files.open(path);
    else await this.files.add(path, text);
    this.editor.focus();
  }

  // Make TEXT the text of the file PATH. If it has another one, the user is asked.
  async write(path, text) {
    this.show();
    const { files } = this;
    await files.there;
    await files.save();
    await files.refresh();
    if (files.paths.includes(path) && (await tab.file("read", { path })) !== text) {
      if (!(await ask({ text: t("The file {path} has another text. Replace it?", { path }), ok: t("Replace") }))) return;
    }
    await files.write(path, text);
    this.editor.focus();
  }

  // -------------------------------------------------------------------------------------------------------------- packages

  async export() {
    await this.files.save();
    const inPackage = this.#home() !== null;
    let name = this.#home() ?? kept("package", "my_plans");
    if (!inPackage) {
      name = await ask({
        text: t("Name of the package"),
        field: name,
        ok: t("Export"),
        hint: t("All files that are in no package yet go into it, with a package.xml and an .asd."),
      });
      if (!name) return;
      keep("package", name);
    }
    const { name: file, data } = await tab.ask("export", { path: this.files.path, name });
    download(file, Uint8Array.from(atob(data), (each) => each.charCodeAt(0)));
    this.say(t("{file} was saved. Unpack it in the src folder of a catkin workspace.", { file }));
  }

  // The name of the package that the open file is in; null if it is in none.
  #home() {
    const parts = this.files.path.split("/").slice(0, -1);
    for (; parts.length; parts.pop()) if (this.files.paths.includes(`${parts.join("/")}/package.xml`)) return parts.at(-1);
    return null;
  }

  import() {
    byId("code-zip").click();
  }

  // Import the file of a package, a File of the browser's.
  async unpack(file) {
    if (file.size > MOST) {
      const sizes = { size: Math.ceil(file.size / 1e6), most: MOST / 1e6 };
      throw new Error(t("This file is too large: {size} MB, and at most {most} MB are imported.", sizes));
    }
    const bytes = new Uint8Array(await file.arrayBuffer());
    let data = "";
    for (let place = 0; place < bytes.length; place += 8192) data += String.fromCharCode(...bytes.subarray(place, place + 8192));
    data = btoa(data);
    await this.files.save();
    let found = await tab.ask("import", { data });
    if (found.there) {
      const text = t("There is a folder {name} already. Replace it? What is in it now is gone then.", { name: found.there });
      if (!(await ask({ text, ok: t("Replace") }))) return;
      found = await tab.ask("import", { data, replace: true });
      for (const path of found.files) this.files.states.delete(path);
    }
    await tab.file("keep");
    await this.files.refresh();
    const first = found.files.find((path) => /\.(lisp|hy)$/.test(path)) ?? found.files[0];
    this.files.saved = this.editor.text; // what was there has given way
    await this.files.open(first);
    this.say(t("{count} files were imported.", { count: found.files.length }));
  }

  // ----------------------------------------------------------------------------------------------------------------- links

  async share() {
    await this.files.save();
    const address = `${location.origin}${location.pathname}${location.search}#${await packed(this.files.path, this.editor.text)}`;
    try {
      await navigator.clipboard.writeText(address);
      this.say("A link that holds this file was copied. Whoever opens it sees the file, and nothing runs by itself.");
    } catch {
      await ask({ text: t("A link that holds this file"), field: address, ok: t("Close") });
    }
  }

  // Show the file that the address of the page holds, if it holds one. It is not run.
  async openLink() {
    try {
      const found = await unpacked(location.hash);
      if (!found) return;
      history.replaceState(null, "", location.pathname + location.search);
      await this.put(found.path, found.text);
      this.say("This file came by a link. Look at it before you evaluate it.");
    } catch (problem) {
      this.show();
      this.say(problem.message, "bad");
    }
  }
}

function download(name, bytes) {
  const address = URL.createObjectURL(new Blob([bytes], { type: "application/zip" }));
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
