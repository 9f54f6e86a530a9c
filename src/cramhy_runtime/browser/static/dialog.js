// Questions to the user: a name, or yes or no.

import { el } from "./dom.js";
import { t } from "./texts.js";

// Ask with the TEXT. field: the text that stands in the field at first; without it there is no field. ok: what the button says that agrees.
// Promises the text of the field (or true), or null when the user does not want it.
export function ask({ text, field = null, ok, hint = "" }) {
  return new Promise((answer) => {
    const looks = { type: "text", value: field, "aria-label": text, autocapitalize: "off", spellcheck: "false" };
    const input = field === null ? null : el("input", looks);
    const dialog = el(
      "dialog",
      { class: "question", "aria-label": text },
      el(
        "form",
        { method: "dialog" },
        el("p", {}, text),
        input,
        hint ? el("p", { class: "hint" }, hint) : null,
        el(
          "div",
          { class: "choices" },
          el("button", { type: "submit", value: "ok", class: "main" }, ok),
          el("button", { type: "button", on: { click: () => dialog.close("") } }, t("Cancel")),
        ),
      ),
    );
    dialog.addEventListener("close", () => {
      dialog.remove();
      if (dialog.returnValue !== "ok") answer(null);
      else answer(input ? input.value.trim() : true);
    });
    dialog.addEventListener("keydown", (event) => event.stopPropagation()); // the page has keys of its own
    document.body.append(dialog);
    dialog.showModal();
    input?.select();
  });
}
