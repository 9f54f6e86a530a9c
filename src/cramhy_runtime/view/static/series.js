// The recent past of one fluent, as a step line: a fluent keeps its value until it gets another. Changes that come faster than the
// line could show are thinned, except for the last.

export const WINDOW = 20; // s
const SPACING = WINDOW / 160;

// The number that a fluent's value is drawn as: its own, or truth as 1 and nil as 0; null for anything else.
export function numberOf({ number, value }) {
  if (typeof number === "number" && Number.isFinite(number)) return number;
  if (value === "T") return 1;
  if (value === "NIL") return 0;
  return null;
}

export class Series {
  constructor() {
    this.points = []; // [stamp, number]
  }

  push(stamp, number) {
    const { points } = this;
    while (points.length && points.at(-1)[0] > stamp) points.pop(); // a recording that was put back
    const before = points.at(-2);
    if (before && stamp - before[0] < SPACING) points[points.length - 1] = [stamp, number];
    else points.push([stamp, number]);
    let old = 0; // all that ended before the window; the one that reaches into it stays
    while (old + 1 < points.length && points[old + 1][0] < stamp - WINDOW) old++;
    if (old > 32) points.splice(0, old);
  }

  // An SVG path over width × height for the WINDOW that ends at `now`; "" with fewer than one number.
  path(now, width, height) {
    const begin = now - WINDOW;
    const points = this.points.filter(([stamp], index, all) => stamp <= now && (stamp >= begin || !(all[index + 1]?.[0] < begin)));
    if (!points.length) return "";
    let least = Infinity;
    let most = -Infinity;
    for (const [, number] of points) {
      least = Math.min(least, number);
      most = Math.max(most, number);
    }
    const span = most - least;
    const x = (stamp) => (((Math.max(stamp, begin) - begin) / WINDOW) * width).toFixed(1);
    const y = (number) => (span ? height - ((number - least) / span) * height : height / 2).toFixed(1);
    let d = "";
    for (const [stamp, number] of points) d += d ? `H${x(stamp)}V${y(number)}` : `M${x(stamp)} ${y(number)}`;
    return `${d}H${width}`;
  }
}
