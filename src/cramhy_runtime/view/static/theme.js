// Light or dark: as the system says, until somebody chooses. For a projector in either of them: large type and high contrast.

import { setText } from "./dom.js";
import { keep, kept, offerSwitch } from "./settings.js";
import { t } from "./texts.js";

const NAMES = { auto: t("auto"), light: t("light"), dark: t("dark") };
const THEMES = Object.keys(NAMES);

export function offerThemes(button, projector) {
  let theme;
  const enter = (chosen) => {
    theme = THEMES.includes(chosen) ? chosen : "auto";
    document.documentElement.dataset.theme = theme;
    setText(button.lastElementChild, NAMES[theme]);
  };
  enter(kept("theme", "auto"));
  button.addEventListener("click", () => {
    enter(THEMES[(THEMES.indexOf(theme) + 1) % THEMES.length]);
    keep("theme", theme);
  });
  offerSwitch(projector, "projector", (on) => document.documentElement.toggleAttribute("data-projector", on));
}
