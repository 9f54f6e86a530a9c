"use strict";
/**
 * The turtle's page beside the editor. `cramhy repl --view` opens its page by the program in the variable BROWSER. That is a script of
 * ours here, which writes the address, with its token, into a file that only the user may read.
 */

const fs = require("fs");
const path = require("path");

class View {
  constructor(vscode, extension, storage) {
    this.vscode = vscode;
    this.script = path.join(extension, "client", "note-address.sh");
    this.storage = storage;
    this.timer = undefined;
  }

  get file() {
    return path.join(this.storage, `address-${process.pid}`);
  }

  /** The variables of the terminal. Windows has no shell for the script: its browser opens instead. */
  environment() {
    if (process.platform === "win32") return {};
    return { BROWSER: `sh '${this.script.replace(/'/g, "")}' %s`, CRAMHY_ADDRESS_FILE: this.file };
  }

  /** Show the page as soon as its address is known; give up after a minute. */
  wait() {
    fs.mkdirSync(this.storage, { recursive: true, mode: 0o700 });
    this.forget();
    const until = Date.now() + 60000;
    this.timer = setInterval(() => {
      if (fs.existsSync(this.file)) {
        const address = fs.readFileSync(this.file, "utf8").trim();
        if (!isOurs(address)) return;
        this.forget();
        this.show(address);
      } else if (Date.now() > until) {
        this.forget();
      }
    }, 200);
  }

  async show(address) {
    try {
      await this.vscode.commands.executeCommand("simpleBrowser.show", address);
    } catch {
      await this.vscode.env.openExternal(this.vscode.Uri.parse(address));
    }
  }

  forget() {
    clearInterval(this.timer);
    fs.rmSync(this.file, { force: true });
  }

  dispose() {
    this.forget();
  }
}

/** Whether an address is one of this machine. */
function isOurs(address) {
  try {
    const url = new URL(address);
    return url.protocol === "http:" && ["127.0.0.1", "localhost", "[::1]"].includes(url.hostname);
  } catch {
    return false;
  }
}

module.exports = { View, isOurs };
