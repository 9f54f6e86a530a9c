// What the user must be told about the page itself: whether it is connected, and what went wrong.

import { STATES } from "./connection.js";
import { setText } from "./dom.js";
import { t } from "./texts.js";

const NOTICE = 8000; // ms for which a complaint stands
const NAMES = {
  [STATES.CONNECTING]: t("connecting"),
  [STATES.OPEN]: t("connected"),
  [STATES.LOST]: t("connection lost"),
  [STATES.REFUSED]: t("refused"),
};
const LOST = t("The connection to the session is lost. Trying again; what you see is the last that was heard.");
const REFUSED = t("Open the address that it prints; it has a new token each time.");

export class StatusView {
  constructor({ pill, banner, notice }) {
    Object.assign(this, { pill, banner, notice });
    this.timer = null;
  }

  // One of the STATES of a connection; detail: what the session said when it refused.
  connection(state, detail) {
    const again = state === STATES.CONNECTING && this.pill.dataset.state === STATES.LOST; // each attempt would be read out
    if (!again) {
      this.pill.dataset.state = state;
      setText(this.pill, NAMES[state]);
    }
    if (state === STATES.LOST) setText(this.banner, LOST);
    if (state === STATES.REFUSED) setText(this.banner, `${t("The session does not let this page in")}${detail ? `: ${detail.replace(/\.$/, "")}` : ""}. ${REFUSED}`);
    if (state !== STATES.CONNECTING) this.banner.hidden = state === STATES.OPEN;
    document.body.classList.toggle("offline", state !== STATES.OPEN);
  }

  // Say for a while what went wrong.
  failed(error) {
    this.say(error.message, "bad");
  }

  say(text, kind = "good") {
    this.notice.dataset.kind = kind;
    setText(this.notice, text);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.hush(), NOTICE);
  }

  // Take back what is said now; whether something was.
  hush() {
    const said = this.notice.textContent !== "";
    setText(this.notice, "");
    return said;
  }
}
