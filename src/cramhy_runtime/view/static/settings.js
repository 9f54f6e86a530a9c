// What somebody chose about the page itself, kept by the browser for the next time. A browser that keeps nothing for pages forgets it
// with the page.

const PREFIX = "cramhy-";

export function kept(name, otherwise) {
  try {
    return localStorage.getItem(PREFIX + name) ?? otherwise;
  } catch {
    return otherwise;
  }
}

export function keep(name, value) {
  try {
    localStorage.setItem(PREFIX + name, value);
  } catch {
    // as above
  }
}

// Let `button` be a switch: changed(on) is called now, and whenever somebody uses it. Without a name the choice is not kept.
export function offerSwitch(button, name, changed) {
  const enter = (on) => {
    button.setAttribute("aria-pressed", String(on));
    changed(on);
  };
  enter((name && kept(name) ? kept(name) : button.getAttribute("aria-pressed")) === "true");
  button.addEventListener("click", () => {
    const on = button.getAttribute("aria-pressed") !== "true";
    if (name) keep(name, String(on));
    enter(on);
  });
}
