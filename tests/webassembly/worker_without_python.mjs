// Stands for the worker of a tab, without Python: a prompt that answers with the length of what was typed, files in memory, and an error
// for (error); (where) is answered with where it stands. So the page is tested without the seconds that Python takes.

const files = new Map([["plans.lisp", "(defun one () 1)\n"], ["turtle.hy", "(defn two [] 2)\n"], ["picture.png", null]]);
let prompt = { text: "CL-USER> ", language: "lisp", package: ["COMMON-LISP-USER", "CL-USER"], virtual: true };
let error = null;
let imports = 0;
const tell = (kind, value = null) => postMessage({ kind, value });
const answer = (id, value) => tell("answer", { id, answer: value });
const refuse = (id, refused) => tell("answer", { id, refused });

function wait() {
  tell("debug", error);
  tell("prompt", error ? { ...prompt, text: `${error.level}] ` } : prompt);
}

function evaluate(line, place) {
  tell("busy");
  tell("text", `${error ? "0] " : prompt.text}${line}\n`);
  if (line === "(in-hy)") prompt = { ...prompt, text: "=> ", language: "hy" };
  else if (line.startsWith("(in-package")) prompt = { ...prompt, text: "TUT> ", language: "lisp", package: ["TUT"] };
  else if (line === "(error)") {
    error = {
      level: 0,
      type: "SIMPLE-ERROR",
      restarts: [{ name: "CONTINUE", report: "Go on." }, { name: "ABORT", report: "Return to top level." }],
      frames: [{ call: "(DRIVE 5)", place: "plans.lisp:3:1", variables: [["SPEED", "5"]] }],
    };
  } else if (line === "(where)") tell("text", `${JSON.stringify(place)}\n`);
  else if (error && line === "1") error = null;
  else tell("text", `${line.length}\n`);
  wait();
}

const asked = {
  complete: ({ text, language, package: name }) =>
    ({ length: /[\w-]*$/.exec(text)[0].length, options: [[`${language}-name`, "what it is"], [`name-in-${name}`, ""]] }),
  arglist: ({ text }) => (text.includes("(drive ") ? { name: "drive", items: ["speed", "&optional", "angle"], place: 0 } : null),
  export: ({ path, name }) => ({ name: `${name}.zip`, data: btoa(`of ${path}`) }),
  import: ({ replace }) => {
    imports++;
    if (!replace) return { there: "my_plans" };
    files.set("my_plans/src/a.lisp", ";; imported\n");
    return { files: ["my_plans/package.xml", "my_plans/src/a.lisp"] };
  },
  page: () => null,
  check: ({ task }) => ({ passed: true, told: [`${task} is right.`] }),
};

const done = {
  list: () => [...files.keys()].sort(),
  read: ({ path }) => files.get(path),
  write({ path, text }) {
    files.set(path, text);
    return true;
  },
  rename({ path, to }) {
    files.set(to, files.get(path));
    files.delete(path);
    return true;
  },
  delete: ({ path }) => files.delete(path),
  keep: () => true,
};

function begin() {
  for (const kind of ["python", "imported", "files", "ready"]) tell(kind);
  wait();
}

onmessage = ({ data: { kind, value, place = null } }) => {
  if (kind === "begin") begin();
  else if (kind === "lines") value.forEach((line, number) => evaluate(line, number === value.length - 1 ? place : null));
  else if (kind === "ask") {
    if (value.what === "import" && atob(value.data) === "broken") refuse(value.id, "This file is broken.");
    else answer(value.id, asked[value.what](value));
  } else if (kind === "file") answer(value.id, done[value.what](value));
};
