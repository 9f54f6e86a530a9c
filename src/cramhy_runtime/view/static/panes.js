// Where there is no room for all panels side by side, one of them is shown, and buttons choose which. Where there is room, the style
// shows all of them and no buttons.

import { keep, kept } from "./settings.js";

const FIRST = "tasks";

export function offerPanes(main, tabs) {
  const buttons = [...tabs.querySelectorAll("button")];
  const enter = (name) => {
    main.dataset.pane = name;
    for (const button of buttons) button.setAttribute("aria-pressed", String(button.dataset.pane === name));
  };
  const wanted = kept("pane", FIRST);
  enter(buttons.some(({ dataset }) => dataset.pane === wanted) ? wanted : FIRST);
  tabs.addEventListener("click", ({ target }) => {
    const name = target.closest("button")?.dataset.pane;
    if (!name) return;
    keep("pane", name);
    enter(name);
  });
}
