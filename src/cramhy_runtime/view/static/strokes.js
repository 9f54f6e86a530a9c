// Everything that the pens have drawn, with the time of each line, so that the paper can be shown as it was at any moment that is
// still known. Columns of numbers, not objects: a turtle that drives for an hour draws two hundred thousand lines. Lines are numbered
// from the first that the page heard of; older ones that it asks for later get numbers below. A new epoch begins with a clean
// paper. Past a limit the oldest lines are given up, with the moments at which only they were drawn.

const MOST = 300_000;
const STEP = 4096;
const BLANK = [69, 86, 255]; // the original's paper, before there is one
const COLUMNS = { xy: 4, ink: 1, stamps: 1 };

export class Strokes {
  constructor(most = MOST) {
    this.most = most;
    this.forget();
  }

  forget() {
    this.length = this.room = 0;
    this.first = 0; // the number of the oldest line that is kept
    this.ground = 0; // the number after the lines of the first message, whose own times are not known
    this.xy = new Float32Array(0); // x1 y1 x2 y2
    this.ink = new Uint32Array(0); // width << 24 | red << 16 | green << 8 | blue
    this.stamps = new Float64Array(0);
    this.epochs = []; // {clears, colour, start, stamp}
  }

  get end() {
    return this.first + this.length;
  }

  // The earliest time of which the paper is known.
  get start() {
    return this.epochs.length ? this.epochs[0].stamp : Infinity;
  }

  // A World message; what the paper is after it: {strokes: the number after the last line, epoch}.
  add(world) {
    const fresh = !this.epochs.length;
    if (fresh || world.complete || this.epochs.at(-1).clears !== world.clears) {
      this.epochs.push({ clears: world.clears, colour: world.clears ? [world.r, world.g, world.b] : BLANK, start: this.end, stamp: world.stamp });
    }
    const { strokes } = world;
    this.#reserve(this.length + strokes.length);
    for (const stroke of strokes) {
      const at = this.length * 4;
      this.xy[at] = stroke.x1;
      this.xy[at + 1] = stroke.y1;
      this.xy[at + 2] = stroke.x2;
      this.xy[at + 3] = stroke.y2;
      this.ink[this.length] = ((stroke.width & 255) << 24) | (stroke.r << 16) | (stroke.g << 8) | stroke.b;
      this.stamps[this.length++] = world.stamp;
    }
    if (fresh) this.ground = this.end;
    return { strokes: this.end, epoch: this.epochs.at(-1) };
  }

  // Put the lines of an earlier time, which end where these began, in the place of the ground. Samples that name an epoch or a
  // number stay right.
  prepend(older) {
    const shift = this.ground - older.end;
    const skipped = this.ground - this.first;
    const length = older.length + this.length - skipped;
    const room = Math.max(length, STEP);
    for (const [name, width] of Object.entries(COLUMNS)) {
      const joined = new this[name].constructor(room * width);
      joined.set(older[name].subarray(0, older.length * width));
      joined.set(this[name].subarray(skipped * width, this.length * width), older.length * width);
      this[name] = joined;
    }
    for (const epoch of older.epochs) epoch.start += shift;
    const [here] = this.epochs;
    const joint = older.epochs.pop();
    here.start = joint.start;
    here.stamp = joint.stamp;
    this.epochs.unshift(...older.epochs);
    Object.assign(this, { length, room, first: this.ground - older.length, ground: older.ground + shift });
  }

  // Whether there are more lines than shall be kept.
  get full() {
    return this.length > this.most;
  }

  // Give up the lines before the number `to`. The paper can be shown from then on, if somebody keeps a picture of it.
  drop(to) {
    const count = to - this.first;
    const stamp = this.stamps[count - 1];
    for (const [name, width] of Object.entries(COLUMNS)) this[name].copyWithin(0, count * width, this.length * width);
    this.length -= count;
    this.first = to;
    this.ground = Math.max(this.ground, to);
    while (this.epochs.length > 1 && this.epochs[1].start <= to) this.epochs.shift();
    this.epochs[0].stamp = Math.max(this.epochs[0].stamp, stamp);
  }

  // The epoch to which the paper belongs once the line before the number `end` is drawn.
  epochOf(end) {
    return this.epochs.findLast((epoch) => epoch.start < end) ?? this.epochs[0];
  }

  // What the paper was at `stamp`: {strokes, epoch}.
  at(stamp) {
    const epoch = this.epochs.findLast((one) => one.stamp <= stamp) ?? this.epochs[0] ?? null;
    let low = 0;
    let high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.stamps[middle] <= stamp) low = middle + 1;
      else high = middle;
    }
    return { strokes: this.first + low, epoch };
  }

  #reserve(wanted) {
    if (wanted <= this.room) return;
    this.room = Math.max(wanted, this.room * 2, STEP);
    for (const [name, width] of Object.entries(COLUMNS)) {
      const grown = new this[name].constructor(this.room * width);
      grown.set(this[name]);
      this[name] = grown;
    }
  }
}
