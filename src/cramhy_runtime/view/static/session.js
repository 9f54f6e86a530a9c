// What the page knows of the session: it subscribes, asks for everything at once after each connection, notes all that comes, and asks
// for earlier chapters when somebody wants to look further back. It draws nothing.

import { Connection } from "./connection.js";
import { History } from "./history.js";
import { State } from "./state.js";
import { Strokes } from "./strokes.js";

const TOPICS = {
  world: ["/cramhy/world", "cramhy_msgs/World"],
  tasks: ["/cramhy/tasks", "cramhy_msgs/TaskTree"],
  fluents: ["/cramhy/fluents", "cramhy_msgs/Fluents"],
  modules: ["/cramhy/process_modules", "cramhy_msgs/ProcessModules"],
  robots: ["/cramhy/robot_world", "cramhy_msgs/RobotWorld"],
  pace: ["/cramhy/pace", "cramhy_msgs/Pace"],
};
const KINDS = Object.keys(TOPICS);
const CHANGING = KINDS.filter((kind) => kind !== "pace"); // those that the past is told of
const POSE = ["x", "y", "theta", "linear_velocity", "angular_velocity"];
const QUEUE = { queue_length: 0 }; // every line counts
const ANEW = 1500; // ms after which the state is asked for again when that failed
const MOST_OLDER = 400_000; // lines of earlier chapters

export class Session {
  // heard(kind, message, sample) is called for each message of the live session, anew() before everything is
  // told of another one, older() when earlier times have come to be known, rosout(message), connection(state, detail), failed(error),
  // moved(message) when another session takes the place of this one.
  constructor({ url, token, heard, anew, older, rosout, moved, connection, failed, now = () => performance.now(), make }) {
    Object.assign(this, { heard, anew, older, failed, now });
    this.history = new History();
    this.strokes = new Strokes();
    this.joined = false;
    this.arrival = 0; // ms, of the last stamp
    this.chapter = null; // the oldest one that was fetched: {chapter, oldest}
    this.fetching = false;
    this.wanted = null; // the time of the recording that is to be sought next
    this.seeking = null; // a promise, while one is being sought
    this.bridge = new Connection({ url, token, make, changed: (state, detail) => {
      if (state !== "open") this.joined = false;
      connection(state, detail);
    }, opened: () => this.#join(), status: (level, text) => level === "error" && failed(new Error(text)) });
    for (const [kind, [topic, type]] of Object.entries(TOPICS)) {
      this.bridge.subscribe(topic, type, (message) => this.#hear(kind, message), QUEUE);
    }
    this.bridge.subscribe("/rosout", "rosgraph_msgs/Log", rosout, QUEUE);
    this.bridge.subscribe("/cramhy/moved", "std_msgs/String", moved);
  }

  connect() {
    this.bridge.connect();
  }

  get live() {
    return this.history.live;
  }

  get start() {
    return Math.max(this.history.start, Math.min(this.strokes.start, this.history.end));
  }

  // Plan time now, s: between two messages it is taken to pass as the pace says.
  get time() {
    const { stamp, pace } = this.live;
    if (!this.joined || !pace || pace.paused) return stamp;
    if (!pace.virtual) return stamp + (this.now() - this.arrival) / 1000;
    return pace.busy && pace.speed > 0 ? stamp + Math.min(((this.now() - this.arrival) / 1000) * pace.speed, pace.speed) : stamp;
  }

  // The world at a moment of the past: {stamp, turtles, strokes, epoch}.
  worldAt(stamp, state = this.history.at(stamp)) {
    return { stamp, turtles: state.world?.turtles ?? [], ...this.strokes.at(stamp) };
  }

  // Whether there is more to look back at than is here.
  get more() {
    return this.joined && this.chapter !== null && this.chapter.chapter > this.chapter.oldest && this.strokes.length < MOST_OLDER;
  }

  // Fetch the chapter before the oldest that is here, if there is one.
  async earlier() {
    if (!this.more || this.fetching) return;
    await this.#fetch(this.chapter.chapter - 1);
  }

  // Go to a time of the recording that is replayed; the promise ends when the session is there. Of times that are wanted while it is
  // on its way only the last one counts: a slider tells sixty a second.
  seek(stamp) {
    this.wanted = stamp;
    this.seeking ??= this.#seek().finally(() => (this.seeking = null));
    return this.seeking;
  }

  async #seek() {
    while (this.wanted !== null) {
      const stamp = this.wanted;
      this.wanted = null;
      await this.bridge.call("/cramhy/seek", { stamp });
    }
  }

  async #join() {
    try {
      const told = await this.bridge.call("/cramhy/get_state");
      for (const message of Object.values(told)) message.complete = true;
      const same = !told.pace.recording && this.history.end > 0 && told.world.stamp >= this.history.end;
      this.joined = true;
      if (same) for (const kind of KINDS) this.#hear(kind, told[kind]);
      else this.#begin(told);
      if (!same && !told.pace.recording) this.#fetch(0);
    } catch (error) {
      if (!this.bridge.open) return;
      this.failed(error);
      setTimeout(() => this.bridge.open && !this.joined && this.#join(), ANEW);
    }
  }

  #begin(told) {
    this.anew();
    this.history.restart(new State());
    this.strokes.forget();
    this.chapter = null;
    for (const kind of KINDS) {
      const { message, sample } = this.#sample(kind, told[kind], this.strokes);
      this.live.apply(kind, message);
      this.heard(kind, message, sample);
    }
    this.arrival = this.now();
  }

  #hear(kind, message) {
    if (!this.joined) return; // the answer to get_state will have it
    const { recording } = this.live.pace;
    if (recording && message.complete) {
      this.live.stamp = message.stamp; // somebody sought, maybe back
      if (kind === "world") this.strokes.forget();
    }
    const { message: noted, sample } = this.#sample(kind, message, this.strokes);
    if (recording) this.live.apply(kind, noted);
    else this.history.add(kind, noted);
    this.arrival = this.now();
    this.heard(kind, noted, sample);
  }

  // Of a World the lines go to `strokes`; what is noted is where the turtles were.
  #sample(kind, message, strokes) {
    if (kind !== "world") return { message, sample: null };
    const { stamp, turtles, simulator } = message;
    for (const turtle of turtles) for (const key of POSE) turtle[key] ??= NaN; // JSON has none
    return { message: { stamp, turtles, simulator }, sample: { stamp, turtles, ...strokes.add(message) } };
  }

  async #fetch(number) {
    this.fetching = true;
    const { history, strokes } = this;
    const { start } = history;
    try {
      const told = await this.bridge.call("/cramhy/get_history", { chapter: number });
      if (start !== history.start) return; // everything has begun anew meanwhile
      this.chapter = { chapter: told.chapter, oldest: told.oldest };
      if (told.begin < start) this.#prepend(told, start);
    } catch (error) {
      if (this.bridge.open && number) this.failed(error); // a session in which nothing has happened has no newest chapter
    } finally {
      this.fetching = false;
    }
  }

  // Put a chapter, up to the time `end`, before what is known.
  #prepend(told, end) {
    const lines = new Strokes(Infinity);
    const first = new State();
    const messages = [];
    for (const kind of CHANGING) {
      first.apply(kind, this.#sample(kind, { ...told[kind], stamp: told.begin, complete: true }, lines).message);
      for (const message of told[`later_${kind}`]) {
        if (message.stamp <= end) messages.push({ kind, message: this.#sample(kind, message, lines).message });
      }
    }
    messages.sort((one, other) => one.message.stamp - other.message.stamp); // stable: those of one kind stay in order
    this.strokes.prepend(lines);
    this.history.prepend(first, messages);
    this.older();
  }
}
