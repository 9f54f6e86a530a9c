// What the page remembers: all messages with their times, in chapters that begin with the whole state, so that any moment is found
// by reading one chapter. It is bounded by what it holds, not by time: past the limit the oldest chapter is forgotten.

import { State } from "./state.js";

const CHAPTER = 256; // messages
const MOST = 600_000; // entries of messages: a turtle, a task, a fluent each count for one
const SPACING = 0.03; // s between two poses that are kept; the last one always is

export class History {
  constructor(most = MOST) {
    this.most = most;
    this.live = new State();
    this.clear();
  }

  clear() {
    this.chapters = [];
    this.cost = 0;
  }

  // Begin anew with a state in which everything is known.
  restart(state) {
    this.clear();
    this.live = state;
  }

  get start() {
    return this.chapters.length ? this.chapters[0].stamp : this.live.stamp;
  }

  get end() {
    return this.live.stamp;
  }

  // Note a message of `kind`, and let it change the live state.
  add(kind, message) {
    let chapter = this.chapters.at(-1);
    if (!chapter || chapter.entries.length >= CHAPTER) chapter = this.#open();
    this.live.apply(kind, message);
    const entry = { kind, message, stamp: this.live.stamp };
    const cost = weight(kind, message);
    if (kind === "world" && replaces(chapter, entry)) return;
    chapter.entries.push(entry);
    if (kind === "world") chapter.worlds = [...chapter.worlds.slice(-1), entry];
    chapter.cost += cost;
    this.cost += cost;
    while (this.cost > this.most && this.chapters.length > 1) this.cost -= this.chapters.shift().cost;
  }

  // Put older messages, [{kind, message}] in order, before everything that is known; `state` is what they begin with.
  prepend(state, messages) {
    const older = new History(Infinity);
    older.restart(state);
    older.#open();
    for (const { kind, message } of messages) older.add(kind, message);
    this.chapters.unshift(...older.chapters);
    this.cost += older.cost;
  }

  #open() {
    const state = this.live.copy();
    const chapter = { stamp: state.stamp, state, entries: [], cost: state.tasks.size + state.fluents.size + 1, worlds: [] };
    this.chapters.push(chapter);
    this.cost += chapter.cost;
    return chapter;
  }

  // The State at `stamp`, the nearest that is known.
  at(stamp) {
    const chapter = this.chapters.findLast((one) => one.stamp <= stamp) ?? this.chapters[0];
    if (!chapter) return this.live.copy();
    const state = chapter.state.copy();
    for (const entry of chapter.entries) {
      if (entry.stamp > stamp) break;
      state.apply(entry.kind, entry.message);
    }
    state.stamp = Math.min(Math.max(stamp, this.start), this.end);
    return state;
  }

  // Messages of `kind` with start <= stamp <= end, oldest first.
  *between(kind, start, end) {
    const first = this.chapters.findLastIndex((chapter) => chapter.stamp < start);
    for (const chapter of this.chapters.slice(Math.max(first, 0))) {
      for (const entry of chapter.entries) {
        if (entry.stamp > end) return;
        if (entry.stamp >= start && entry.kind === kind) yield entry;
      }
    }
  }
}

// Of poses that follow each other closely only every second or third is kept.
function replaces(chapter, entry) {
  const [before, last] = chapter.worlds;
  if (!last || !before || last !== chapter.entries.at(-1)) return false;
  if (entry.stamp - before.stamp >= SPACING || last.message.turtles.length !== entry.message.turtles.length) return false;
  Object.assign(last, entry);
  return true;
}

function weight(kind, message) {
  if (kind === "world") return 1 + message.turtles.length;
  if (kind === "tasks") return 1 + message.tasks.length;
  if (kind === "fluents") return 1 + message.fluents.length;
  if (kind === "robots") return 2 + 20 * (message.things?.length ?? 0) + (message.steps?.length ?? 0);
  return 2;
}
