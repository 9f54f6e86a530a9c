// Which world is on the stage: the turtles' paper, or the robot's room where the session has one. What draws the room is loaded when it first
// has something in it, so that a session of turtles does without.

import { setText } from "./dom.js";
import { keep, kept } from "./settings.js";
import { t } from "./texts.js";

export class Stage {
  // stage, controls: where picture and buttons of the room go. worlds: the buttons that choose, where there are both. live(): the State now.
  // move, failed, say: see Room.
  constructor({ stage, controls, worlds, title, tab, live, move, failed, say }) {
    Object.assign(this, { stage, controls, worlds, title, tab, live, move, failed, say });
    this.room = null;
    this.loading = null;
    worlds.addEventListener("click", ({ target }) => {
      const name = target.closest("button")?.dataset.stage;
      if (!name) return;
      keep("stage", name);
      this.#choose();
    });
    this.#choose();
  }

  // A RobotWorld of the live session, which its state knows of already.
  hear(message) {
    const { robots } = this.live();
    if (this.room) this.room.hear(message, robots);
    else if (robots.things.size) this.loading ??= this.#load();
    this.#choose();
  }

  async #load() {
    try {
      const { Room } = await import("./space/room.js");
      const { stage, controls, move, failed, say } = this;
      this.room = new Room({ stage, controls, move, failed, say });
      this.room.restart(this.live().robots);
      this.#choose();
    } catch (error) {
      this.failed(error);
    }
  }

  get showsRoom() {
    return document.body.dataset.stage === "room";
  }

  // What was known of the room at a moment of the past, or with null the live one.
  showPast(known, text) {
    this.room?.showPast(known, text);
  }

  frame(now) {
    this.room?.frame(now);
  }

  read() {
    this.#choose();
    if (this.showsRoom) this.room?.read();
  }

  #choose() {
    const { robots, world } = this.live();
    const room = Boolean(this.room) && robots.things.size > 0;
    const both = room && Boolean(world?.simulator);
    const wanted = both ? kept("stage", "room") : room ? "room" : "paper";
    this.worlds.hidden = !both;
    if (document.body.dataset.stage === wanted) return;
    document.body.dataset.stage = wanted;
    setText(this.title, wanted === "room" ? t("The robot's world") : t("The turtles' world"));
    setText(this.tab, wanted === "room" ? t("Robot") : t("Turtle"));
    for (const button of this.worlds.children) button.setAttribute("aria-pressed", String(button.dataset.stage === wanted));
  }
}
