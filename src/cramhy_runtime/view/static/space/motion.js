// Motions, one after the other, at a pace that one can follow. In projection a plan does much in no time; the page shows each motion for as
// long as it seems to take, and catches up when many wait.

import { blend } from "./maths.js";

const BACKLOG = 4; // s of waiting motions, from which on they are shown faster

export class Motion {
  // still(): whether the user wants no motion; then each one is a jump.
  constructor(still = () => false) {
    this.still = still;
    this.forget();
  }

  forget() {
    this.states = new Map(); // where things are seen, name → WorldState
    this.queue = []; // WorldSteps that wait; the first is being shown
    this.begun = null; // ms, when the first one was begun
    this.from = this.states;
  }

  // A WorldStep, or several.
  add(steps) {
    for (const step of steps) {
      if (!this.queue.length && (!(step.seconds > 0) || this.still())) this.#enter(step);
      else this.queue.push(step);
    }
  }

  // Let all motions have happened; whether there were any.
  hurry() {
    const waited = this.queue.length > 0;
    for (const step of this.queue.splice(0)) this.#enter(step);
    this.begun = null;
    return waited;
  }

  drop(name) {
    this.states.delete(name);
  }

  get moving() {
    return this.queue.length > 0;
  }

  // Go on to the time `now` (ms); whether anything has moved.
  advance(now) {
    if (!this.queue.length) return false;
    const waiting = this.queue.reduce((sum, { seconds }) => sum + seconds, 0);
    const rate = Math.max(1, waiting / BACKLOG);
    if (this.begun === null) this.#begin(now);
    this.passed += ((now - this.last) / 1000) * rate;
    this.last = now;
    while (this.queue.length && this.passed >= this.queue[0].seconds) {
      const step = this.queue.shift();
      this.states = new Map(this.from);
      this.#enter(step);
      this.passed -= step.seconds;
      this.from = new Map(this.states);
    }
    if (!this.queue.length) {
      this.begun = null;
      return true;
    }
    const share = smooth(this.passed / this.queue[0].seconds);
    this.states = new Map(this.from);
    for (const state of this.queue[0].states) this.states.set(state.name, between(this.from.get(state.name), state, share));
    return true;
  }

  #begin(now) {
    this.begun = this.last = now;
    this.passed = 0;
    this.from = new Map(this.states);
  }

  #enter({ states }) {
    for (const state of states) this.states.set(state.name, state);
  }
}

const smooth = (share) => share * share * (3 - 2 * share);

// A thing on its way from one state to another: its joints in between, so that arms keep their length.
export function between(from, to, share) {
  if (!from || share >= 1) return to;
  const joints = to.joints.map((value, index) => {
    const before = from.joints[index] ?? value;
    return before + (value - before) * share;
  });
  return { ...to, pose: blend(from.pose, to.pose, share), joints };
}
