// What the editors ask the session for: completions, and how the call at the cursor is written.

import { el } from "./dom.js";
import { tab } from "./tab.js";

const PAUSE = 120; // ms without a key, after which the call at the cursor is looked at

// For an `Editor`: completes a text, in what surroundings(text) says of its end, {language, name}.
export function completer(surroundings) {
  return async (text) => {
    const { language, name } = surroundings(text);
    if (language === "text") return null;
    try {
      return await tab.ask("complete", { text, language, package: name ?? null });
    } catch {
      return null; // Python is not there
    }
  };
}

// Shows how the call at the cursor is written, the argument that is typed in bold.
export class Arguments {
  constructor(place) {
    this.place = place;
  }

  look(text, { language, name }) {
    clearTimeout(this.timer);
    this.timer = setTimeout(async () => {
      const number = (this.number = (this.number ?? 0) + 1);
      const found =
        text.trim() && tab.ready && language !== "text"
          ? await tab.ask("arglist", { text, language, package: name ?? null }).catch(() => null)
          : null;
      if (number === this.number) this.#show(found);
    }, PAUSE);
  }

  #show(found) {
    if (!found) return this.place.replaceChildren();
    const items = found.items.flatMap((item, index) => [" ", index === found.place ? el("b", {}, item) : item]);
    if (!found.name) return this.place.replaceChildren(...items.slice(1));
    return this.place.replaceChildren("(", found.name, ...items, ")");
  }
}
