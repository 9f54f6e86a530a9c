// The prompt of the session in the worker: what it prints, the line that is typed, its history, Ctrl-C, and the button that starts Python
// anew when nothing else helps.

import { byId } from "./dom.js";

const DEAF = 2000; // ms after Ctrl-C without an answer, after which the page says what helps
const MOST = 400_000; // characters of the transcript that are kept
const KEPT = 200; // forms of the history that are kept between visits

export const supported = typeof WebAssembly === "object" && typeof WebAssembly.Suspending === "function";

class Tab {
  constructor() {
    this.sockets = new Set(); // that wait for the session or talk with it
    this.printed = 0; // characters
    this.prompts = 0; // that there have been
  }

  begin() {
    this.ready = false;
    this.worker = new Worker(`worker.mjs${location.search}`, { type: "module" });
    this.worker.onmessage = ({ data: { kind, value } }) => this.#told[kind]?.(value);
    this.worker.onerror = (event) => this.failed(event.message || "the worker cannot be loaded");
    document.body.dataset.prompt = "begins";
    this.say("loading Python …");
  }

  // ---------------------------------------------------------------------------------------------------------- the views

  // Call CALL once, when there is a session.
  whenReady(call) {
    this.told = call;
    if (this.ready) call();
  }

  join(socket, port) {
    this.worker?.postMessage({ kind: "port" }, [port]);
    this.sockets.add(socket);
    if (this.ready) queueMicrotask(() => socket.onopen?.());
  }

  leave(socket) {
    if (this.sockets.delete(socket)) queueMicrotask(() => socket.onclose?.({ code: 1000, reason: "" }));
  }

  // ------------------------------------------------------------------------------------------------- what the worker tells

  #told = {
    python: () => this.say("Python is there; unpacking …"),
    imported: () => this.say("making the session …"),
    ready: () => {
      this.ready = true;
      this.told?.();
      for (const socket of this.sockets) socket.onopen?.();
    },
    text: (value) => this.print(value),
    prompt: (value) => {
      clearTimeout(this.deaf);
      this.say("");
      byId("repl-prompt").textContent = value;
      document.body.dataset.prompts = ++this.prompts;
      document.body.dataset.prompt = "waits";
    },
    busy: () => (document.body.dataset.prompt = "busy"),
    unkept: (value) => this.note(`The browser keeps no files here: ${value}. What you save is gone when this tab is closed.`),
    ended: () => {
      this.say("The session has ended. Press Restart for another one.");
      document.body.dataset.prompt = "ended";
    },
    failed: (value) => this.failed(value),
  };

  print(text) {
    const { out } = this;
    const atEnd = out.scrollHeight - out.scrollTop - out.clientHeight < 40;
    out.append(text);
    this.printed += text.length;
    while (this.printed > MOST && out.childNodes.length > 1) {
      this.printed -= out.firstChild.textContent.length;
      out.firstChild.remove();
    }
    if (atEnd) out.scrollTop = out.scrollHeight;
  }

  failed(value) {
    this.note(`Python has stopped: ${value}\nPress Restart: your files are kept.`);
    document.body.dataset.prompt = "failed";
    this.say("Python has stopped.");
  }

  // ------------------------------------------------------------------------------------------------------------ the user

  open() {
    this.out = byId("repl-out");
    this.input = byId("repl-in");
    this.history = this.#remembered();
    this.place = this.history.length;
    this.input.addEventListener("keydown", (event) => this.#key(event));
    byId("repl-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.enter();
    });
    byId("repl-stop").addEventListener("click", () => this.interrupt());
    byId("repl-restart").addEventListener("click", () => this.restart());
    this.begin();
  }

  enter() {
    const text = this.input.value;
    this.input.value = "";
    this.type(text);
  }

  // Text as if it had been typed, with the Enter key after each of its lines.
  type(text) {
    if (text.trim() && this.history.at(-1) !== text) this.history.push(text);
    this.place = this.history.length;
    try {
      localStorage.setItem("cramhy-history", JSON.stringify(this.history.slice(-KEPT)));
    } catch {
      // a private window keeps nothing
    }
    this.worker.postMessage({ kind: "lines", value: text.split("\n") });
  }

  interrupt() {
    this.worker.postMessage({ kind: "interrupt" });
    clearTimeout(this.deaf);
    this.deaf = setTimeout(() => this.say("No answer to Ctrl-C: the program computes outside of Lisp. Restart ends it; files are kept."), DEAF);
  }

  restart() {
    clearTimeout(this.deaf);
    this.worker.terminate();
    for (const socket of [...this.sockets]) this.leave(socket);
    this.note("Started anew. What was defined is gone; files are kept.");
    this.begin();
  }

  say(text) {
    byId("repl-state").textContent = text;
  }

  note(text) {
    const line = document.createElement("em");
    line.textContent = `\n${text}\n`;
    this.out.append(line);
    this.out.scrollTop = this.out.scrollHeight;
  }

  #remembered() {
    try {
      const found = JSON.parse(localStorage.getItem("cramhy-history") ?? "[]");
      return Array.isArray(found) ? found.filter((each) => typeof each === "string") : [];
    } catch {
      return [];
    }
  }

  #key(event) {
    const { input } = this;
    const nothingChosen = input.selectionStart === input.selectionEnd;
    if (event.key === "Enter" && !event.shiftKey && !event.isComposing) {
      event.preventDefault();
      this.enter();
    } else if (event.key === "c" && event.ctrlKey && nothingChosen) {
      event.preventDefault();
      input.value = "";
      this.interrupt();
    } else if (event.key === "ArrowUp" && nothingChosen && !input.value.slice(0, input.selectionStart).includes("\n")) {
      event.preventDefault();
      this.#recall(-1);
    } else if (event.key === "ArrowDown" && nothingChosen && !input.value.slice(input.selectionEnd).includes("\n")) {
      event.preventDefault();
      this.#recall(1);
    }
  }

  #recall(step) {
    const place = this.place + step;
    if (place < 0 || place > this.history.length) return;
    this.place = place;
    this.input.value = this.history[place] ?? "";
  }
}

export const tab = new Tab();

if (supported) {
  tab.open();
  navigator.serviceWorker?.register("offline.js").catch(() => {}); // without one the page needs its network again
} else {
  byId("unfit").hidden = false;
  document.body.dataset.prompt = "unfit";
}
