// The way that the turtles have taken, as dots, also where the pen was up. A dot is noted when a turtle is a tenth of a metre away from
// its last one, so that a turtle that stands costs nothing. Dots have the time at which they were made: looking back, those of later are
// left out, and so are those from before the paper was cleared. Drawn dots stay on a sheet of their own, which is only added to.

const SPACING = 0.1; // m
const MOST = 20_000; // dots: two kilometres; with more, every other one goes

export class Way {
  constructor() {
    this.forget();
  }

  forget() {
    this.dots = []; // [stamp, x, y], in order of time
    this.last = new Map(); // name of a turtle → its last dot
    this.spacing = SPACING;
    this.version = (this.version ?? 0) + 1; // changes when dots go, or come in between
  }

  // Where the turtles were at `stamp`, which is later than all before.
  note(stamp, turtles) {
    for (const { name, x, y } of turtles) {
      if (!(Math.abs(x) < 1e4 && Math.abs(y) < 1e4)) continue;
      const last = this.last.get(name);
      if (last && Math.hypot(x - last[1], y - last[2]) < this.spacing) continue;
      const dot = [stamp, x, y];
      this.last.set(name, dot);
      this.dots.push(dot);
    }
    if (this.dots.length <= MOST) return;
    this.dots = this.dots.filter((_, index) => index % 2 === 0);
    this.spacing *= 2;
    this.version++;
  }

  // Begin anew with all that is known: entries {message: {stamp, turtles}}, the oldest first.
  restart(entries) {
    this.forget();
    for (const { message } of entries) this.note(message.stamp, message.turtles);
  }

  // The numbers of the dots made from `start` to `end`: the first of them, and the one after the last.
  between(start, end) {
    const index = (stamp, later) => {
      let low = 0;
      let high = this.dots.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (later ? this.dots[middle][0] <= stamp : this.dots[middle][0] < stamp) low = middle + 1;
        else high = middle;
      }
      return low;
    };
    return [index(start, false), index(end, true)];
  }
}
