"use strict";
/**
 * As much of VS Code's interface as the extension and vscode-languageclient use, for `drive.js`. Classes that hold data are real, since the
 * client fills and reads them. Events are kept and can be fired. Everything else is noted in `seen` and answers nothing.
 */

const { pathToFileURL, fileURLToPath } = require("url");
const { EventEmitter: Emitter } = require("events");

const seen = { commands: new Map(), terminals: [], messages: [], diagnostics: new Map(), providers: {}, log: "" };

class Disposable {
  constructor(action) {
    this.dispose = action || (() => undefined);
  }
}

class EventEmitter {
  constructor() {
    this.emitter = new Emitter();
    this.event = (listener, self, disposables) => {
      const bound = self ? listener.bind(self) : listener;
      this.emitter.on("x", bound);
      const found = new Disposable(() => this.emitter.off("x", bound));
      if (disposables) disposables.push(found);
      return found;
    };
  }
  fire(value) {
    this.emitter.emit("x", value);
  }
  dispose() {
    this.emitter.removeAllListeners();
  }
}

class Uri {
  constructor(text) {
    this.text = text;
    const url = new URL(text);
    Object.assign(this, { scheme: url.protocol.slice(0, -1), authority: url.host, path: url.pathname, query: "", fragment: "" });
  }
  get fsPath() {
    return fileURLToPath(this.text);
  }
  toString() {
    return this.text;
  }
  static file(name) {
    return new Uri(pathToFileURL(name).href);
  }
  static parse(text) {
    return new Uri(text);
  }
}

class Position {
  constructor(line, character) {
    Object.assign(this, { line, character });
  }
}
class Range {
  constructor(start, end, line, character) {
    Object.assign(this, start instanceof Position ? { start, end } : { start: new Position(start, end), end: new Position(line, character) });
  }
}
class Selection extends Range {
  get active() {
    return this.end;
  }
  get isEmpty() {
    return this.start.line === this.end.line && this.start.character === this.end.character;
  }
}
class Diagnostic {
  constructor(range, message, severity) {
    Object.assign(this, { range, message, severity });
  }
}

class CancellationTokenSource {
  constructor() {
    this.token = { isCancellationRequested: false, onCancellationRequested: new EventEmitter().event };
  }
  cancel() {
    this.token.isCancellationRequested = true;
  }
  dispose() {}
}

/** A text with the methods that the client asks. */
class Document {
  constructor(uri, languageId, text) {
    Object.assign(this, { uri, languageId, text, version: 1, isDirty: false, isClosed: false, fileName: uri.fsPath, lineCount: text.split("\n").length });
  }
  getText() {
    return this.text;
  }
  offsetAt({ line, character }) {
    return this.text.split("\n").slice(0, line).reduce((sum, each) => sum + each.length + 1, 0) + character;
  }
  async save() {
    this.isDirty = false;
    return true;
  }
}

const named = (name) => ({ [name]: class { constructor(...parts) { this.parts = parts; } } })[name];
/** A namespace whose unknown functions do nothing, whose onDid... are events, and whose names with a capital are classes. */
function space(known) {
  return new Proxy(known, {
    get(target, name) {
      if (name in target || typeof name !== "string") return target[name];
      if (name.startsWith("on")) target[name] = new EventEmitter().event;
      else if (name.startsWith("register")) target[name] = (...parts) => ((seen.providers[name] = parts), new Disposable());
      else if (/^[A-Z]/.test(name)) target[name] = Object.assign(named(name), { Empty: { append: () => ({}) } });
      else target[name] = () => undefined;
      return target[name];
    },
    has: () => true,
  });
}

const opened = new EventEmitter();
const channel = new Proxy({}, { get: (_, name) => (name === "name" ? "cramhy" : (text) => ["append", "appendLine", "info", "debug", "trace", "error", "warn"].includes(name) && (seen.log += `${text}\n`)) });
const say = (kind) => (text) => (seen.messages.push([kind, text]), Promise.resolve(undefined));
const workspace = space({
  workspaceFolders: [],
  textDocuments: [],
  onDidOpenTextDocument: opened.event,
  getConfiguration: (section) => ({ get: (name, otherwise) => ((seen.settings || {})[`${section}.${name}`] ?? otherwise), inspect: () => undefined }),
  getWorkspaceFolder: () => undefined,
  createFileSystemWatcher: () => ({ ...space({}), onDidCreate: new EventEmitter().event, onDidChange: new EventEmitter().event, onDidDelete: new EventEmitter().event, dispose() {} }),
  applyEdit: async () => true,
});
const vscode = space({
  version: "1.96.0",
  CancellationTokenSource, Disposable, EventEmitter, Uri, Position, Range, Selection, Diagnostic, workspace,
  DiagnosticSeverity: { Error: 0, Warning: 1, Information: 2, Hint: 3 },
  env: space({ language: "en", appName: "drive", uiKind: 1 }),
  extensions: space({ all: [], getExtension: () => undefined }),
  window: space({
    visibleTextEditors: [],
    createOutputChannel: () => channel,
    createTerminal: (options) => {
      const made = { options, sent: [], show() {}, dispose() {}, sendText: (text) => made.sent.push(text) };
      seen.terminals.push(made);
      return made;
    },
    showInformationMessage: say("info"), showWarningMessage: say("warning"), showErrorMessage: say("error"),
    tabGroups: space({ all: [], onDidChangeTabs: new EventEmitter().event }),
  }),
  languages: space({
    match: (selector, document) => ([].concat(selector).some((each) => each.language === document.languageId) ? 10 : 0),
    createDiagnosticCollection: () => ({
      set: (uri, found) => seen.diagnostics.set(String(uri), found || []),
      delete: (uri) => seen.diagnostics.delete(String(uri)), clear() {}, dispose() {}, get: (uri) => seen.diagnostics.get(String(uri)),
    }),
  }),
  commands: space({
    registerCommand: (name, action, self) => {
      if (seen.commands.has(name)) throw new Error(`the command ${name} is registered twice`);
      seen.commands.set(name, self ? action.bind(self) : action);
      return new Disposable(() => seen.commands.delete(name));
    },
    executeCommand: async (name, ...parts) => (seen.commands.has(name) ? seen.commands.get(name)(...parts) : undefined),
  }),
});

module.exports = { vscode, seen, opened, Document, Selection, Position };
