// A client of the rosbridge protocol (version 2, JSON over a WebSocket) that keeps its session: when the connection is lost it says
// so, tries again by itself, ever more slowly up to a limit, and subscribes to everything anew. The token is in the address that it
// connects to, so that the server lets it in before those who have none; it goes out as the first message, too, with the wish to be an
// observer, whom the lists of the graph do not show. What was asked and not answered when the connection broke is refused, never
// repeated: a second /reset is not the same as one.

import { t } from "./texts.js";

const FIRST_PAUSE = 400; // ms
const LONGEST_PAUSE = 5000;
const PATIENCE = 10_000; // ms that an answer may take
const SILENCE = 3000; // ms without a word after which the server is asked, and as many until it must have answered
const POLICY = 1008; // the code with which a server turns somebody away

export const STATES = Object.freeze({ CONNECTING: "connecting", OPEN: "open", LOST: "lost", REFUSED: "refused" });

export class Connection {
  // url: ws://…; token: string or null. changed(state, detail) is called with each of STATES; `opened` after each (re)connection;
  // `status` with the server's own complaints. `make` builds the socket, so that tests can give another.
  constructor({ url, token = null, changed = () => {}, opened = () => {}, status = () => {}, make = (address) => new WebSocket(address) }) {
    Object.assign(this, { url, token, changed, opened, status, make });
    this.listeners = new Map(); // topic → {type, hear}
    this.advertised = new Set();
    this.pending = new Map(); // id → {resolve, reject, timer}
    this.count = 0;
    this.pause = FIRST_PAUSE;
    this.socket = null;
    this.bare = false; // whether the token goes out with the first message alone
    this.silence = null;
    this.timer = null;
    this.state = null;
  }

  connect() {
    clearTimeout(this.timer);
    this.timer = null;
    this.#enter(STATES.CONNECTING);
    const socket = (this.socket = this.make(this.#address()));
    this.heard = this.entered = false;
    this.#expect(socket);
    socket.onopen = () => {
      this.entered = true;
      this.#expect(socket);
      if (this.token) this.#send({ op: "auth", token: this.token, hidden: true });
      for (const [topic, { type, options }] of this.listeners) this.#send({ op: "subscribe", topic, type, ...options });
      this.advertised.clear();
      this.pause = FIRST_PAUSE;
      this.#enter(STATES.OPEN);
      this.opened();
    };
    socket.onmessage = ({ data }) => {
      this.#expect(socket);
      this.#receive(data);
    };
    socket.onclose = ({ code, reason }) => this.#closed(socket, code, reason);
  }

  // Call hear(message) for each message on the topic, over all reconnections.
  subscribe(topic, type, hear, options = {}) {
    this.listeners.set(topic, { type, hear, options });
    if (this.open) this.#send({ op: "subscribe", topic, type, ...options });
  }

  // Whether the message went out; what cannot be sent now is not kept, for a command to a turtle is for now.
  publish(topic, type, msg) {
    if (!this.open) return false;
    if (!this.advertised.has(topic)) {
      this.#send({ op: "advertise", topic, type });
      this.advertised.add(topic);
    }
    this.#send({ op: "publish", topic, msg });
    return true;
  }

  // The service's answer; an Error with the server's text when it fails, or when nothing comes within `patience` ms.
  call(service, args = {}, patience = PATIENCE) {
    if (!this.open) return Promise.reject(new Error(t("{service} was not called: there is no connection.", { service })));
    const id = `call:${++this.count}`;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => {
        this.pending.delete(id);
        reject(new Error(t("{service} has not answered for {seconds} seconds.", { service, seconds: patience / 1000 })));
      }, patience);
      this.pending.set(id, { resolve, reject, timer, service });
      this.#send({ op: "call_service", id, service, args });
    });
  }

  get open() {
    return this.state === STATES.OPEN;
  }

  // A server that refuses the token in the address cannot tell a page why. So after an attempt that did not get in, the next one shows the
  // token with the first message alone, and is told.
  #address() {
    return this.token && !this.bare ? `${this.url}?token=${encodeURIComponent(this.token)}&hidden=1` : this.url;
  }

  // A session that is stopped, or a network that is gone, closes nothing. So when nothing has come for a while the server is asked, whose
  // answer needs no plan's attention; when none comes, the connection is given up for a new one.
  #expect(socket) {
    clearTimeout(this.silence);
    this.silence = setTimeout(() => {
      if (socket !== this.socket) return;
      if (this.open) this.#send({ op: "ping" });
      this.silence = setTimeout(() => this.#closed(socket, 1006, ""), SILENCE);
    }, SILENCE);
  }

  #send(message) {
    this.socket.send(JSON.stringify(message));
  }

  #receive(data) {
    this.heard = true;
    try {
      const message = JSON.parse(data);
      if (message.op === "publish") this.listeners.get(message.topic)?.hear(message.msg);
      else if (message.op === "service_response") this.#answered(message);
      else if (message.op === "status") this.status(message.level, String(message.msg));
    } catch (error) {
      this.status("error", t("A message of the session could not be read: {why}", { why: error.message })); // the next one counts
    }
  }

  #answered({ id, values, result }) {
    const waiting = this.pending.get(id);
    if (!waiting) return;
    this.pending.delete(id);
    clearTimeout(waiting.timer);
    if (result === false) waiting.reject(new Error(typeof values === "string" && values ? values : t("{service} failed.", waiting)));
    else waiting.resolve(values ?? {});
  }

  #closed(socket, code, reason) {
    if (socket !== this.socket) return;
    clearTimeout(this.silence);
    this.socket = null;
    socket.close();
    if (!this.entered) this.bare = !this.bare;
    for (const { reject, timer, service } of this.pending.values()) {
      clearTimeout(timer);
      reject(new Error(t("{service}: the connection was lost.", { service })));
    }
    this.pending.clear();
    if (code === POLICY && !this.heard) { // later on it only means that we were too slow
      this.#enter(STATES.REFUSED, reason);
      return;
    }
    this.#enter(STATES.LOST, this.pause);
    this.timer = setTimeout(() => this.connect(), this.pause);
    this.pause = Math.min(this.pause * 1.6, LONGEST_PAUSE);
  }

  #enter(state, detail) {
    this.state = state;
    this.changed(state, detail);
  }
}
