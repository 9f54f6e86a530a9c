// The prompt of the session in the worker: what it prints, the form that is typed, its history, Ctrl-C, and the button that starts Python
// anew when nothing else helps.

import { Arguments, completer } from "./asking.js";
import { byId } from "./dom.js";
import { Editor } from "./editor.js";
import { isOpen } from "./forms.js";
import { tab } from "./tab.js";
import { t } from "./texts.js";

const MOST = 400_000; // characters of the transcript that are kept
const KEPT = 200; // forms of the history that are kept between visits
const HISTORY = "cramhy-history";
const HELP =
  "Enter sends a form that is complete, Shift and Enter begins another line, the arrow keys recall what was typed, Tab completes, and " +
  "Ctrl-C stops what runs.";

export class Prompt {
  constructor() {
    this.out = byId("repl-out");
    this.printed = 0; // characters
    this.atEnd = true; // whether the last line is to be in sight
    this.top = 0;
    this.history = remembered();
    this.place = this.history.length;
    const language = () => tab.prompt.language;
    this.input = new Editor({
      place: byId("repl-place"),
      id: "repl-in",
      label: t("Form to evaluate"),
      describedBy: t(HELP),
      complete: completer(() => ({ language: language() })),
      moved: () => this.arguments?.look(this.input.text.slice(0, this.input.cursor), { language: language() }),
      keys: [
        { key: "Enter", run: () => this.#enterIfComplete(), shift: () => (this.input.insert("\n"), true) },
        { key: "Ctrl-c", run: () => this.#interruptUnlessChosen() },
        { key: "ArrowUp", run: () => this.#recall(-1) },
        { key: "ArrowDown", run: () => this.#recall(1) },
      ],
    });
    this.arguments = new Arguments(byId("repl-args"));
    byId("repl-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.enter();
    });
    byId("repl-prompt").addEventListener("click", () => this.input.focus());
    byId("repl-stop").addEventListener("click", () => tab.interrupt());
    byId("repl-restart").addEventListener("click", () => {
      tab.restart(t("Started anew. What was defined is gone; files are kept."));
    });
    new ResizeObserver(() => this.atEnd && this.#toEnd()).observe(this.out); // a debugger takes room from it
    this.out.addEventListener("scroll", () => this.#scrolled());
    this.#listen();
  }

  #listen() {
    tab.on("state", (state) => {
      if (state === "begins") this.say(t("loading Python …"));
      else if (state === "waits") this.say("");
      else if (state === "reads") this.say(t("The program reads a line."));
      else if (state === "ended") this.say(t("The session has ended. Press Restart for another one."));
      else if (state === "failed") this.say(t("Python has stopped."));
    });
    tab.on("python", () => this.say(t("Python is there; unpacking …")));
    tab.on("imported", () => this.say(t("making the session …")));
    tab.on("text", (text) => this.print(text));
    tab.on("anew", (why) => this.note(why));
    tab.on("prompt", ({ text, language = "lisp" }) => {
      byId("repl-prompt").textContent = text;
      byId("repl-title").textContent = language === "hy" ? "Hy" : "Lisp";
      if (this.input.language !== language) this.input.speak(language);
    });
    tab.on("deaf", () => this.say(t("No answer to Ctrl-C: the program computes outside of Lisp. Restart ends it; files are kept.")));
    tab.on("failed", (why) => this.note(t("Python has stopped: {why}\nPress Restart: your files are kept.", { why })));
    tab.on("unkept", (why) =>
      this.note(
        why === "another tab"
          ? t("This course is open in another tab, which keeps the files. What you save here is gone when this tab is closed.")
          : t("The browser keeps no files here: {why}. What you save is gone when this tab is closed.", { why }),
      ),
    );
  }

  print(text) {
    const { out, atEnd } = this;
    out.append(text);
    this.printed += text.length;
    while (this.printed > MOST && out.childNodes.length > 1) {
      this.printed -= out.firstChild.textContent.length;
      out.firstChild.remove();
    }
    if (atEnd) this.#toEnd();
  }

  enter() {
    const { text } = this.input;
    this.input.open("", this.input.language);
    this.remember(text);
    tab.type(text);
  }

  remember(text) {
    if (text.trim() && this.history.at(-1) !== text) this.history.push(text);
    this.place = this.history.length;
    try {
      localStorage.setItem(HISTORY, JSON.stringify(this.history.slice(-KEPT)));
    } catch {
      // a private window keeps nothing
    }
  }

  say(text) {
    byId("repl-state").textContent = text;
  }

  note(text) {
    const line = document.createElement("em");
    line.textContent = `\n${text}\n`;
    this.out.append(line);
    this.#toEnd();
  }

  #toEnd() {
    this.out.scrollTop = this.out.scrollHeight;
    this.atEnd = true;
    this.top = this.out.scrollTop;
  }

  // Only the user leaves the end; a box that becomes smaller does not.
  #scrolled() {
    const { scrollTop, scrollHeight, clientHeight } = this.out;
    this.atEnd = scrollHeight - scrollTop - clientHeight < 40 || (this.atEnd && scrollTop >= this.top);
    this.top = scrollTop;
  }

  // Enter behind a form that is open begins another line, as in a terminal.
  #enterIfComplete() {
    const { text, cursor } = this.input;
    if (!text.slice(cursor).trim() && tab.state !== "reads" && isOpen(text)) return false;
    this.enter();
    return true;
  }

  #interruptUnlessChosen() {
    if (this.input.chosen.text) return false; // the browser copies it
    this.input.open("", this.input.language);
    tab.interrupt();
    return true;
  }

  #recall(step) {
    const { text, cursor } = this.input;
    const place = this.place + step;
    if (this.input.completes || (step < 0 ? text.slice(0, cursor) : text.slice(cursor)).includes("\n")) return false;
    if (place < 0 || place > this.history.length) return true;
    this.place = place;
    this.input.text = this.history[place] ?? "";
    return true;
  }
}

function remembered() {
  try {
    const found = JSON.parse(localStorage.getItem(HISTORY) ?? "[]");
    return Array.isArray(found) ? found.filter((each) => typeof each === "string") : [];
  } catch {
    return [];
  }
}
