// The session of this tab, as the page sees it: the worker in which Python runs, what is told by it, and what it is asked.

const DEAF = 2000; // ms after Ctrl-C without an answer, after which the page says what helps
const SPARE = 5000; // ms after the first prompt, when another Python is made ready, so that a restart does not have to wait for it
const ROOM = 2; // GB of memory that a machine needs for another Python, which takes 70 MB (Chromium 156)

const hasRoom = () => navigator.hardwareConcurrency > 1 && (navigator.deviceMemory ?? ROOM) >= ROOM;
const python = () => globalThis.newPython(); // of begin.js

export const supported = typeof WebAssembly === "object" && typeof WebAssembly.Suspending === "function";

class Tab {
  constructor() {
    this.sockets = new Set(); // of the views: they wait for the session or talk with it
    this.questions = new Map(); // number -> {resolve, reject}
    this.number = 0;
    this.listeners = new Map();
    this.spare = globalThis.firstPython ?? null; // a Python that is being made ready
    this.state = "begins"; // "waits", "reads" (a program wants a line), "busy", "ended", "failed", "unfit"
    this.prompt = { text: "", language: "lisp", package: ["COMMON-LISP-USER", "CL-USER"], virtual: true };
    this.lispPackage = "CL-USER"; // to which Lisp returns after Hy
    this.prompts = 0; // that there have been
  }

  // CALL is called with the value of each news of that kind: "state", "python", "imported", "ready", "files", "text", "prompt", "debug",
  // "anew", "unkept", "ended", "failed", "deaf".
  on(kind, call) {
    if (!this.listeners.has(kind)) this.listeners.set(kind, []);
    this.listeners.get(kind).push(call);
  }

  #tell(kind, value) {
    for (const call of this.listeners.get(kind) ?? []) call(value);
  }

  #enter(state) {
    this.state = document.body.dataset.prompt = state;
    this.#tell("state", state);
  }

  // ---------------------------------------------------------------------------------------------------------- the worker

  begin() {
    this.ready = false;
    this.begins = true;
    const worker = (this.worker = this.spare ?? python());
    this.spare = null;
    clearTimeout(this.sparing);
    worker.postMessage({ kind: "begin" });
    worker.onmessage = ({ data: { kind, value } }) => {
      if (worker !== this.worker) return; // it was ended
      this.#told[kind]?.(value);
      this.#tell(kind, value);
    };
    worker.onerror = (event) => this.#failed(event.message || "the worker cannot be loaded");
    this.#enter("begins");
  }

  #makeSpare() {
    this.spare = python();
    const forget = () => {
      this.spare = null;
    };
    this.spare.onmessage = ({ data: { kind } }) => kind === "failed" && forget();
    this.spare.onerror = forget;
  }

  // A new session. What was defined is gone. why: what the prompt tells of it.
  restart(why) {
    clearTimeout(this.deaf);
    this.worker.terminate();
    for (const socket of [...this.sockets]) this.leave(socket);
    for (const { reject } of this.questions.values()) reject(new Error("The session was started anew."));
    this.questions.clear();
    this.#tell("debug", null);
    this.#tell("anew", why);
    this.begin();
  }

  unfit() {
    this.#enter("unfit");
  }

  #told = {
    ready: () => {
      this.ready = true;
      this.told?.();
      for (const socket of this.sockets) socket.onopen?.();
    },
    prompt: (value) => {
      clearTimeout(this.deaf);
      if (value.reads) return this.#enter("reads");
      this.prompt = value;
      if (value.language === "lisp") this.lispPackage = value.package[0];
      document.body.dataset.prompts = ++this.prompts;
      if (this.begins && hasRoom()) this.sparing = setTimeout(() => this.#makeSpare(), SPARE);
      this.begins = false;
      return this.#enter("waits");
    },
    busy: () => this.#enter("busy"),
    answer: ({ id, answer, refused }) => {
      const question = this.questions.get(id);
      this.questions.delete(id);
      if (refused === undefined) question?.resolve(answer);
      else question?.reject(new Error(refused));
    },
    ended: () => this.#enter("ended"),
    failed: () => this.#enter("failed"),
  };

  #failed(value) {
    this.#told.failed();
    this.#tell("failed", value);
  }

  // -------------------------------------------------------------------------------------------------- what the page wants

  // Text as if it had been typed, with the Enter key after each of its lines.
  type(text) {
    this.worker.postMessage({ kind: "lines", value: text.split("\n") });
  }

  // Evaluate TEXT at the prompt, as one, in a language ("lisp" or "hy") and in a package of Lisp. What leads there is typed first. At the
  // prompt a long text is not shown whole. place: {path, line, column} of a file, where the text stands.
  run(text, { language = "lisp", name = null, place = null } = {}) {
    this.worker.postMessage({ kind: "lines", value: [...this.#way(language, name), text], place });
  }

  // Let the prompt, which waits, be that of a language. Returns whether something was typed for that: then another prompt comes.
  lead(language) {
    const lines = this.#way(language);
    if (!lines.length) return false;
    this.#enter("busy");
    this.worker.postMessage({ kind: "lines", value: lines });
    return true;
  }

  // The lines that lead to a language, and to a package of Lisp.
  #way(language, name = null) {
    const lines = [];
    if (language === "hy") {
      if (this.prompt.language !== "hy") lines.push("(in-hy)");
    } else {
      const comesFromHy = this.prompt.language === "hy";
      const wanted = name?.toUpperCase() ?? (comesFromHy ? this.lispPackage : null);
      if (wanted !== null && (comesFromHy || !this.prompt.package.includes(wanted))) {
        lines.push(`(in-package :${wanted.toLowerCase()})`);
        this.prompt = { ...this.prompt, package: [wanted] };
      }
    }
    this.prompt = { ...this.prompt, language }; // as it will be, for what is typed before the next prompt comes
    return lines;
  }

  interrupt() {
    this.worker.postMessage({ kind: "interrupt" });
    clearTimeout(this.deaf);
    this.deaf = setTimeout(() => this.#tell("deaf"), DEAF);
  }

  // Ask Python; see desk.py. Promises the answer.
  ask(what, values = {}) {
    return this.#question("ask", { what, ...values });
  }

  // Do something with files; see folder.mjs. Promises the answer.
  file(what, values = {}) {
    return this.#question("file", { what, ...values });
  }

  #question(kind, value) {
    const id = ++this.number;
    return new Promise((resolve, reject) => {
      this.questions.set(id, { resolve, reject });
      this.worker.postMessage({ kind, value: { id, ...value } });
    });
  }

  // ---------------------------------------------------------------------------------------------------------- the views

  // Call CALL when there is a session.
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
}

export const tab = new Tab();
