// The page in the language of the system. English stands in the code; a table for another language has what is said instead of it.
//
// `t` gives the text that is said. `translate` goes over what stands in the page already: texts, titles and labels.

import { TABLES } from "./tables.js";

const ATTRIBUTES = ["title", "aria-label", "placeholder"];
const wanted = [new URLSearchParams(globalThis.location?.search).get("lang"), ...(globalThis.navigator?.languages ?? [])]
  .filter(Boolean)
  .map((tag) => tag.toLowerCase().split("-")[0]);

// The first of the user's languages that there is.
export const language = wanted.find((tag) => tag === "en" || tag in TABLES) ?? "en";
const table = TABLES[language] ?? {};

// TEXT in that language, with the VALUES of its {names}.
export const t = (text, values = {}) => (table[text] ?? text).replace(/\{(\w+)\}/g, (_, name) => values[name]);

export function translate(root) {
  document.documentElement.lang = language;
  if (language === "en") return;
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT | NodeFilter.SHOW_ELEMENT);
  for (let node = walker.currentNode; node; node = walker.nextNode()) {
    if (node.nodeType === Node.TEXT_NODE) {
      const said = table[node.data.trim().replace(/\s+/g, " ")];
      if (said) node.data = node.data.replace(/\S[\s\S]*\S|\S/, () => said);
    } else {
      for (const name of ATTRIBUTES) {
        const said = table[node.getAttribute(name)?.replace(/\s+/g, " ")];
        if (said) node.setAttribute(name, said);
      }
    }
  }
}
