// Light or dark: as the system says, until somebody chooses.

import { setText } from "./dom.js";

const NAMES = { auto: "auto", light: "light", dark: "dark" };
const ORDER = Object.keys(NAMES);
const KEY = "cramhy-theme";

export function offerThemes(button) {
  let theme = "auto";
  try {
    theme = localStorage.getItem(KEY) ?? theme;
  } catch {
    // a browser that keeps nothing for pages: then the choice lasts as long as the page
  }
  const enter = (chosen) => {
    theme = chosen in NAMES ? chosen : "auto";
    document.documentElement.dataset.theme = theme;
    setText(button.lastElementChild, NAMES[theme]);
  };
  enter(theme);
  button.addEventListener("click", () => {
    enter(ORDER[(ORDER.indexOf(theme) + 1) % ORDER.length]);
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // as above
    }
  });
}
