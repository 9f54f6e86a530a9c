// What can be shown on the paper besides lines and turtles: a grid of metres, the goals of running motions, the way already taken.
// They are light on a dark paper and dark on a light one.

import { decimal } from "./format.js";
import { EXTENT, METRE, SIZE, place, placeUp } from "./paper.js";

const LIGHT = "255 255 255";
const DARK = "20 20 30";
const EVERY = 5; // metres between two lines that are stronger
const RING = 0.2; // m, the radius of a goal
const DOT = 0.045; // m, of the way

const inkOn = ([red, green, blue]) => (red * 0.3 + green * 0.59 + blue * 0.11 > 150 ? DARK : LIGHT);

// What the marks need to know: `pen` draws into a square of `side` device pixels on the paper's `colour`; `type` is the height of text.
export const drawing = (pen, side, colour, type) => {
  const scale = side / SIZE;
  const ink = inkOn(colour);
  return { pen, side, scale, type, ink, halo: ink === LIGHT ? DARK : LIGHT, left: (x) => place(x) * scale, top: (y) => placeUp(y) * scale };
};

export function drawGrid({ pen, side, scale, type, ink, left, top }) {
  pen.font = `${type}px system-ui, sans-serif`;
  pen.fillStyle = `rgb(${ink} / 0.85)`;
  for (let metre = 0; metre <= EXTENT; metre++) {
    pen.lineWidth = Math.max(1, scale) * (metre % EVERY ? 0.5 : 1);
    pen.strokeStyle = `rgb(${ink} / ${metre % EVERY ? 0.3 : 0.55})`;
    pen.beginPath();
    pen.moveTo(left(metre), 0);
    pen.lineTo(left(metre), side);
    pen.moveTo(0, top(metre));
    pen.lineTo(side, top(metre));
    pen.stroke();
    if (!metre || side < type * 30 && metre % EVERY) continue; // no room for all numbers
    pen.textAlign = "left";
    pen.textBaseline = "bottom";
    pen.fillText(metre, left(metre) + type * 0.2, side - type * 0.15);
    pen.fillText(metre, type * 0.25, top(metre) - type * 0.1);
  }
}

// goals: [{x, y}].
export function drawGoals({ pen, side, scale, type, ink, halo, left, top }, goals) {
  const radius = RING * METRE * scale;
  pen.font = `600 ${type}px system-ui, sans-serif`;
  pen.textBaseline = "bottom";
  for (const { x, y } of goals) {
    if (!(Math.abs(x) < 1e4 && Math.abs(y) < 1e4)) continue;
    const [column, row] = [left(x), top(y)];
    const cross = new Path2D();
    cross.arc(column, row, radius, 0, 2 * Math.PI);
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      cross.moveTo(column + dx * radius * 0.5, row + dy * radius * 0.5);
      cross.lineTo(column + dx * radius * 1.5, row + dy * radius * 1.5);
    }
    const text = `${decimal(x)}, ${decimal(y)}`;
    const right = column + radius * 1.6 + pen.measureText(text).width < side;
    pen.textAlign = right ? "left" : "right";
    const at = [text, column + (right ? 1 : -1) * radius * 1.2, Math.max(row - radius, type * 1.1)];
    for (const [colour, width] of [[`rgb(${halo} / 0.75)`, 2.2], [`rgb(${ink})`, 1]]) { // a dark rim, so that it is seen on every line
      pen.strokeStyle = colour;
      pen.lineWidth = width * 2 * Math.max(1, scale);
      pen.stroke(cross);
      if (width > 1) pen.strokeText(...at);
    }
    pen.fillStyle = `rgb(${ink})`;
    pen.fillText(...at);
  }
}

// The dots of a `way` from `start` to `end`, on a sheet that is kept from one frame to the next.
export class WaySheet {
  constructor(way) {
    this.way = way;
    this.canvas = document.createElement("canvas");
    this.drawn = null; // {version, side, ink, first, last} that the sheet shows
  }

  // Draw what is due into the picture; `paper` is a `drawing`.
  show({ pen, side, scale, ink, left, top }, start, end) {
    const [first, last] = this.way.between(start, end);
    const { version } = this.way;
    const { drawn } = this;
    let from = drawn?.last;
    if (!drawn || drawn.version !== version || drawn.side !== side || drawn.ink !== ink || drawn.first !== first || drawn.last > last) {
      this.canvas.width = this.canvas.height = side; // which clears it
      from = first;
    }
    const dots = this.canvas.getContext("2d");
    dots.fillStyle = `rgb(${ink} / 0.8)`;
    dots.beginPath();
    for (let index = from; index < last; index++) {
      const [, x, y] = this.way.dots[index];
      dots.moveTo(left(x), top(y));
      dots.arc(left(x), top(y), DOT * METRE * scale, 0, 2 * Math.PI);
    }
    dots.fill();
    this.drawn = { version, side, ink, first, last };
    pen.drawImage(this.canvas, 0, 0);
  }
}
