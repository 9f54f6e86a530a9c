// Light or dark: as the system says, until somebody chooses.

import { setText } from "./dom.js";

const THEMES = ["auto", "light", "dark"];
const KEY = "cramhy-theme";

export function offerThemes(button) {
  let theme = "auto";
  try {
    theme = localStorage.getItem(KEY) ?? theme;
  } catch {
    // a browser that keeps nothing for pages: then the choice lasts as long as the page
  }
  const enter = (chosen) => {
    theme = THEMES.includes(chosen) ? chosen : "auto";
    document.documentElement.dataset.theme = theme;
    setText(button.lastElementChild, theme);
  };
  enter(theme);
  button.addEventListener("click", () => {
    enter(THEMES[(THEMES.indexOf(theme) + 1) % THEMES.length]);
    try {
      localStorage.setItem(KEY, theme);
    } catch {
      // as above
    }
  });
}
