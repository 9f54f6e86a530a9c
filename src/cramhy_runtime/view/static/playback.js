// Motion at the screen's pace. The world ticks every 16 ms of plan time and its messages come in clumps; a screen has frames of its
// own. So what is shown lags a little behind, and between two ticks the turtles are where a straight move would have them.
// Each tick is due at the moment that its stamp tells, as long as plan time passes evenly; where it jumps, at its arrival.

const DELAY = 60; // ms by which the picture lags: more than the usual clump, less than one notices
const STRAY = 120; // ms between the told and the real arrival, from which on the telling is given up
const CORRECTION = 0.08; // of a smaller error, taken back with each tick
const FULL_TURN = 2 * Math.PI;
const LEAP = 1.5; // m within one tick: a teleport, which is not a move
const MOST = 240; // ticks that are kept for a screen that does not come to draw

export class Playback {
  constructor(delay = DELAY) {
    this.delay = delay;
    this.samples = [];
    this.last = null;
    this.rate = 1; // plan seconds per second; 0: uneven
  }

  clear() {
    this.samples.length = 0;
    this.last = null;
  }

  // A tick {stamp, turtles, strokes} that came at `arrival` (ms).
  push(sample, arrival) {
    let due = arrival;
    if (this.last && this.rate > 0) {
      const told = this.last.due + ((sample.stamp - this.last.stamp) * 1000) / this.rate;
      const error = arrival - told;
      if (Math.abs(error) < STRAY) due = told + error * CORRECTION;
    }
    const entry = { due: Math.max(due, this.last?.due ?? due), stamp: sample.stamp, sample };
    this.samples.push(entry);
    this.last = entry;
    if (this.samples.length > MOST) this.samples.splice(0, this.samples.length - MOST);
  }

  // What is to be seen at `now` (ms): {stamp, turtles, strokes}, or null before the first tick.
  at(now) {
    const time = now - this.delay;
    const samples = this.samples;
    let passed = 0;
    while (passed + 1 < samples.length && samples[passed + 1].due <= time) passed++;
    if (passed) samples.splice(0, passed);
    if (!samples.length) return null;
    const [from, to] = samples;
    if (!to || time <= from.due) return from.sample;
    return between(from.sample, to.sample, (time - from.due) / (to.due - from.due));
  }

  // Whether there is more to come than what is on the screen.
  get moving() {
    return this.samples.length > 1;
  }
}

// The world at the fraction `part` of the way between two ticks.
export function between(from, to, part) {
  const old = new Map(from.turtles.map((turtle) => [turtle.name, turtle]));
  const turtles = to.turtles.map((turtle) => {
    const before = old.get(turtle.name);
    return before ? moved(before, turtle, part) : turtle;
  });
  return { stamp: from.stamp + (to.stamp - from.stamp) * part, turtles, strokes: from.strokes, epoch: from.epoch };
}

function moved(from, to, part) {
  const dx = to.x - from.x;
  const dy = to.y - from.y;
  if (!(dx * dx + dy * dy < LEAP * LEAP)) return from;
  let turn = to.theta - from.theta;
  turn -= FULL_TURN * Math.round(turn / FULL_TURN);
  return { ...to, x: from.x + dx * part, y: from.y + dy * part, theta: from.theta + turn * part };
}
