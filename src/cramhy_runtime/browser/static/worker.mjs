// The worker of a tab: Python, a session in it, and its two connections with the page. By postMessage go the prompt's lines, what is
// printed, Ctrl-C, questions, and what is done with files; by a port of its own go the operations of rosbridge, for the views.

import { packages } from "./unpacking.mjs";
import { loadPyodide } from "./pyodide/pyodide.mjs";
import { Folder } from "./folder.mjs";
import { host } from "./stacks.mjs";

const HOME = "/home/pyodide"; // is kept in the browser, between visits and when the worker is ended
const KEEP = 2000; // ms between two times that files are kept while a form runs: somebody may close the tab. At the prompt all are kept
const PACKAGES = "/lib/python3.14/site-packages";

let page = null; // the port of the views
let folder = null; // the user's files
let waiting = null; // resolves the promise that the prompt waits for
const lines = []; // that were typed ahead: {text, place}

const tell = (kind, value = null) => postMessage({ kind, value });

function next() {
  const { text, place } = lines.shift();
  host.place = JSON.stringify(place);
  return text;
}

// What jspi.py and tab.py use. Accessors must stay accessors, which Object.assign would not do.
Object.defineProperties(
  host,
  Object.getOwnPropertyDescriptors({
    receive: null, // set by Python: takes an operation of the page
    interrupt: null, // set by Python: Ctrl-C
    ask: null, // set by Python: a question of the page
    place: "null", // JSON: where the line that was given last stands, {path, line, column}, if the editor has sent it
    prompt: "{}", // JSON: what the page is told of the prompt
    answer: (text) => tell("answer", JSON.parse(text)),
    debug: (text) => tell("debug", JSON.parse(text)),
    say: (text) => page?.postMessage(text),
    later: (milliseconds, call) => {
      setTimeout(call, milliseconds);
    },
    ready: () => tell("ready"),
    wake() {
      waiting?.(null);
    },
    get line() {
      if (lines.length) return Promise.resolve(next());
      tell("prompt", JSON.parse(host.prompt));
      folder.keep();
      return new Promise((resolve) => {
        waiting = (line) => {
          waiting = null;
          tell("busy");
          resolve(line);
        };
      });
    },
  }),
);

const requests = {
  port: (_, [port]) => {
    page = port;
    page.onmessage = ({ data }) => host.receive?.(data);
  },
  lines: (texts, _, place = null) => {
    lines.push(...texts.map((text) => ({ text, place: null })));
    if (lines.length) lines.at(-1).place = place;
    if (waiting && lines.length) waiting(next());
  },
  interrupt: () => {
    lines.length = 0;
    host.interrupt?.();
  },
  ask: (question) => {
    if (host.ask) host.ask(JSON.stringify(question));
    else tell("answer", { id: question.id, refused: "Python is not there yet." });
  },
  file: async ({ id, what, ...rest }) => {
    try {
      if (!folder) throw new Error("the files are not there yet");
      tell("answer", { id, answer: await folder[what](rest) });
    } catch (problem) {
      tell("answer", { id, refused: String(problem.message ?? problem) });
    }
  },
};
const wanted = new Promise((resolve) => {
  requests.begin = resolve; // until then this is made ready: before the page is there, or for a restart
});
onmessage = ({ data: { kind, value, place }, ports }) => requests[kind]?.(value, ports, place);

let python = null;

async function begin() {
  const unpack = packages("./packages.zst");
  python = await loadPyodide({ env: { HOME, PYTHONHASHSEED: "0", ROS_PACKAGE_PATH: `${HOME}:${PACKAGES}/cramhy_runtime/tutorials` } });
  tell("python");
  const decoder = new TextDecoder();
  const out = {
    isatty: false,
    write(bytes) {
      tell("text", decoder.decode(bytes, { stream: true }));
      return bytes.length;
    },
  };
  python.setStdout(out);
  python.setStderr(out);
  python.registerJsModule("cramhy_host", { host });
  await unpack(python);
  const main = python.runPython(`
from cramhy_runtime.browser import left_out
left_out.install()
from cramhy_runtime.browser.tab import main
main`);
  await wanted;
  folder = await Folder.open(python.FS, HOME, (why) => tell("unkept", why));
  tell("files");
  setInterval(() => waiting ?? folder.keep(), KEEP);
  const speed = new URLSearchParams(location.search).get("speed");
  python.FS.chdir(HOME);
  tell("imported");
  const status = await main.callPromising(speed === "unbounded" ? undefined : Number(speed ?? 1));
  folder.keep();
  tell("ended", status);
}

begin().catch((problem) => {
  const complain = () => tell("failed", String(problem?.message ?? problem).slice(-4000));
  complain();
  wanted.then(complain); // nobody may have heard it
});
