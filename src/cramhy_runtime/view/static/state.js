// The session as it was at one moment: tasks, fluents, process modules, pace, turtles and the robot's world. It is built by applying the messages of
// the topics one after the other; messages are never changed, so a copy shares them and costs little.

import { NOTHING, learned } from "./space/news.js";

export class State {
  constructor() {
    this.stamp = 0;
    this.tasks = new Map(); // id → Task, in the order of their beginning
    this.fluents = new Map(); // id → Fluent
    this.modules = [];
    this.pace = null;
    this.world = null; // {stamp, turtles, simulator}
    this.robots = NOTHING; // what is known of the robot's world, see space/news.js
  }

  copy() {
    const other = new State();
    Object.assign(other, this);
    other.tasks = new Map(this.tasks);
    other.fluents = new Map(this.fluents);
    return other;
  }

  // kind: "world", "tasks", "fluents", "modules", "robots" or "pace".
  apply(kind, message) {
    if (message.stamp != null) this.stamp = Math.max(this.stamp, message.stamp);
    if (kind === "tasks") merge(this.tasks, message.tasks, message);
    else if (kind === "fluents") merge(this.fluents, message.fluents, message);
    else if (kind === "modules") this.modules = message.modules;
    else if (kind === "robots") this.robots = learned(this.robots, message);
    else this[kind] = message;
    return this;
  }
}

function merge(known, changed, { complete, removed }) {
  if (complete) known.clear();
  for (const one of changed) known.set(one.id, one);
  for (const id of removed ?? []) known.delete(id);
}

// JSON has no NaN: a time that has not come is null on the wire.
export const told = (number) => typeof number === "number" && !Number.isNaN(number);
