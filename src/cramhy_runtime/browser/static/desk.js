// The desk: the lesson, the editor and the prompt beside the live page. Where there is no room for all of them, one is shown, and buttons
// choose which.

import { byId, el } from "./dom.js";
import { keep, kept } from "./settings.js";
import { offerSplitters } from "./splitters.js";
import { supported, tab } from "./tab.js";
import { t, translate } from "./texts.js";

const PARTS = ["lesson", "code", "repl", "live"];

// Which of lesson and editor is shown where there is room for one of them, and which part where there is room for one alone.
function show(name) {
  document.body.dataset.part = name;
  if (name === "lesson" || name === "code") document.body.dataset.book = name;
  for (const [group, shown] of [["parts", name], ["books", document.body.dataset.book]]) {
    for (const button of byId(group).querySelectorAll("button")) button.setAttribute("aria-pressed", String(button.dataset.part === shown));
  }
  keep("part", name);
}

// In which time plans live: the choice stands among the buttons of the pace.
function offerTime() {
  const choice = el(
    "select",
    { id: "time-kind", title: t("In virtual time, time stands still while the prompt waits") },
    el("option", { value: "virtual" }, t("virtual")),
    el("option", { value: "wall" }, t("the wall's")),
  );
  document.querySelector(".pace").append(el("label", { class: "field" }, el("span", {}, t("time")), choice));
  choice.addEventListener("change", () => {
    const { language } = tab.prompt;
    tab.run(`(${language === "hy" ? "hy.I.cramhy.time" : "cramhy:time"} "${choice.value}")`, { language });
  });
  tab.on("prompt", ({ virtual }) => {
    if (virtual !== undefined) choice.value = virtual ? "virtual" : "wall";
  });
}

// Have the site kept in the browser, once Python is there: it fetches all files, for which a first visit should not wait. Without a service
// worker the page needs its network again.
function keepOffline() {
  let asked = false;
  tab.on("prompt", () => {
    if (!asked) navigator.serviceWorker?.register("offline.js").catch(() => {});
    asked = true;
  });
}

async function start() {
  translate(document.body);
  for (const group of ["parts", "books"]) {
    byId(group).addEventListener("click", ({ target }) => {
      const name = target.closest("button")?.dataset.part;
      if (name) show(name);
    });
  }
  const wanted = kept("part", "lesson");
  document.body.dataset.book = "lesson";
  show(PARTS.includes(wanted) ? wanted : "lesson");
  offerSplitters();
  if (!supported) { // old.js has told it
    tab.unfit();
    return;
  }
  const parts = ["code", "debugger", "lesson", "prompt"].map((name) => import(`./${name}.js`));
  const [{ Code }, { Debugger }, { Lesson }, { Prompt }] = await Promise.all(parts);
  const prompt = new Prompt();
  new Debugger();
  const code = new Code({ show: () => show("code") });
  const lesson = new Lesson({ code, show });
  offerTime();
  tab.begin();
  lesson.begin().catch((problem) => prompt.note(problem.message));
  code.openLink();
  keepOffline();
}

start();
