// The user's files: a folder of Pyodide's file system, which the browser keeps (IndexedDB) between visits and when the worker is ended.
//
// All of it is written at a time, so two tabs of the site would take away each other's files. The one that came first keeps the folder; the
// other one works on a copy, and says so.

const LOCK = "cramhy-files";
const TRIES = 8; // a worker that was ended a moment ago may still have the lock
const PAUSE = 150; // ms between them
const HIDDEN = /^\.|^__pycache__$/;
const MOST = 2_000_000; // bytes of a file that is shown as a text

export class Folder {
  // The folder HOME of the file system FS. unkept(why): nothing is kept.
  static async open(FS, home, unkept) {
    const folder = new Folder(FS, home, unkept);
    try {
      FS.mount(FS.filesystems.IDBFS, {}, home);
      await folder.#sync(true);
      folder.ours = await first();
      if (!folder.ours) unkept("another tab");
    } catch (problem) {
      unkept(String(problem.message ?? problem));
    }
    return folder;
  }

  constructor(FS, home, unkept) {
    Object.assign(this, { FS, home, unkept, ours: false, running: null, again: false });
  }

  // Promises that the files, as they are now, are in the browser's storage; whether they are. Without it (a private window) the session goes on.
  keep() {
    if (!this.ours) return Promise.resolve(false);
    if (this.running) this.again = true;
    else this.running = this.#keepAll().finally(() => (this.running = null));
    return this.running;
  }

  async #keepAll() {
    do {
      this.again = false;
      try {
        await this.#sync(false);
      } catch (problem) {
        this.ours = false;
        this.unkept(String(problem.message ?? problem));
        return false;
      }
    } while (this.again);
    return true;
  }

  #sync(populate) {
    return new Promise((resolve, reject) => this.FS.syncfs(populate, (problem) => (problem ? reject(problem) : resolve())));
  }

  // ------------------------------------------------------------------------------------------------------- what the page asks for

  // The paths of all files, sorted.
  list() {
    const found = [];
    const look = (path) => {
      for (const name of this.FS.readdir(`${this.home}/${path}`)) {
        if (HIDDEN.test(name)) continue;
        const inside = path + name;
        if (this.FS.isDir(this.FS.stat(`${this.home}/${inside}`).mode)) look(`${inside}/`);
        else found.push(inside);
      }
    };
    look("");
    return found.sort();
  }

  // The text of a file; null if it is not a text.
  read({ path }) {
    const bytes = this.FS.readFile(this.#place(path));
    try {
      return bytes.length > MOST ? null : new TextDecoder("utf-8", { fatal: true }).decode(bytes);
    } catch {
      return null;
    }
  }

  // The bytes of a file.
  bytes({ path }) {
    return this.FS.readFile(this.#place(path));
  }

  async write({ path, text }) {
    const place = this.#place(path);
    this.FS.mkdirTree(place.slice(0, place.lastIndexOf("/")));
    this.FS.writeFile(place, text);
    return this.keep();
  }

  async rename({ path, to }) {
    const place = this.#place(to);
    if (this.FS.analyzePath(place).exists) throw new Error(`there is a file ${to} already`);
    this.FS.mkdirTree(place.slice(0, place.lastIndexOf("/")));
    this.FS.rename(this.#place(path), place);
    this.#tidy(path);
    return this.keep();
  }

  async delete({ path }) {
    this.FS.unlink(this.#place(path));
    this.#tidy(path);
    return this.keep();
  }

  // Folders that nothing is left in go with their last file.
  #tidy(path) {
    const parts = path.split("/").slice(0, -1);
    for (; parts.length; parts.pop()) {
      const place = `${this.home}/${parts.join("/")}`;
      const left = this.FS.readdir(place).filter((name) => name !== "." && name !== "..");
      if (left.length) return;
      this.FS.rmdir(place);
    }
  }

  #place(path) {
    const parts = path.split("/");
    if (!path || parts.some((part) => !part || part === "." || part === "..")) throw new Error(`"${path}" is not the name of a file`);
    return `${this.home}/${path}`;
  }
}

// Whether this is the first tab of the site. It stays so until it is closed.
async function first() {
  const { locks } = navigator;
  if (!locks) return true; // nobody can tell
  for (let number = 0; number < TRIES; number++) {
    const got = await new Promise((answer) => {
      locks
        .request(LOCK, { ifAvailable: true }, (lock) => {
          answer(Boolean(lock));
          return lock ? new Promise(() => {}) : undefined;
        })
        .catch(() => answer(true));
    });
    if (got) return true;
    await new Promise((resume) => setTimeout(resume, PAUSE));
  }
  return false;
}
