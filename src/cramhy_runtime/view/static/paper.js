// The turtles' paper and the turtles on it. The paper is a canvas of its own that lines are only added to, so that a frame costs the
// same after an hour as after a second; going back in time starts from the nearest of a few copies made on the way. Turtles are
// drawn over it from little pictures, each painted once from its paths. Coordinates of the world are metres, y up.

export const SIZE = 500; // pixels of the original's paper
export const METRE = 45;
export const EXTENT = SIZE / METRE; // m, of the world
const SCALE = 2; // of ours
const EDGE = SIZE - 1;
const COPIES = 6;
const BETWEEN_COPIES = 5000; // lines
const BOX = 1.5; // m, the side of a turtle's picture

// Where a coordinate of the world lies, in pixels of the original's paper.
export const place = (x) => x * METRE + 0.5;
export const placeUp = (y) => EDGE - y * METRE + 0.5;

const sheet = () => Object.assign(document.createElement("canvas"), { width: SIZE * SCALE, height: SIZE * SCALE });

export class Paper {
  constructor(strokes) {
    this.strokes = strokes;
    this.canvas = sheet();
    this.pen = this.canvas.getContext("2d", { alpha: false, willReadFrequently: false });
    this.pen.lineCap = this.pen.lineJoin = "round";
    this.forget();
  }

  forget() {
    this.epoch = null;
    this.drawn = 0;
    this.copies = []; // {epoch, drawn, canvas}
  }

  // Have the paper show what was drawn up to the line numbered `end` of `epoch`; whether that changed it.
  show(end, epoch) {
    if (!epoch || (epoch === this.epoch && end === this.drawn)) return false;
    this.#paint(end, epoch);
    return true;
  }

  #paint(end, epoch) {
    if (epoch !== this.epoch || end < this.drawn || this.drawn < this.strokes.first) this.#restart(end, epoch);
    while (this.drawn < end) {
      const next = Math.min(end, this.drawn + BETWEEN_COPIES - (this.drawn % BETWEEN_COPIES));
      this.#draw(Math.max(this.drawn, this.strokes.first), next);
      this.drawn = next;
      if (next % BETWEEN_COPIES === 0) this.#keep();
    }
  }

  // Turn the oldest quarter of the lines into a copy, the ground for all later times. What is shown stays.
  settle() {
    const { strokes } = this;
    const end = strokes.first + Math.ceil(strokes.length / 4);
    const ground = new Paper(strokes);
    ground.copies = this.copies.filter((copy) => copy.drawn <= end);
    ground.#paint(end, strokes.epochOf(end));
    strokes.drop(end);
    this.copies = [{ epoch: ground.epoch, drawn: end, canvas: ground.canvas }, ...this.copies.filter((copy) => copy.drawn > end)];
  }

  #restart(end, epoch) {
    const copy = this.copies.findLast((one) => one.epoch === epoch && one.drawn <= end);
    this.epoch = epoch;
    if (copy) {
      this.pen.drawImage(copy.canvas, 0, 0);
      this.drawn = copy.drawn;
      return;
    }
    this.pen.fillStyle = `rgb(${epoch.colour.join(" ")})`;
    this.pen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    this.drawn = Math.min(epoch.start, end);
  }

  #keep() {
    const { epoch, drawn } = this;
    if (this.copies.some((copy) => copy.epoch === epoch && copy.drawn === drawn)) return;
    const canvas = this.copies.length < COPIES ? sheet() : this.copies.splice(Math.floor(this.copies.length / 2), 1)[0].canvas;
    canvas.getContext("2d", { alpha: false }).drawImage(this.canvas, 0, 0);
    this.copies.push({ epoch, drawn, canvas });
    this.copies.sort((one, other) => one.drawn - other.drawn);
  }

  // Lines of one colour and width, each beginning where the last one ended, are one path.
  #draw(from, to) {
    const { strokes, pen } = this;
    const { xy, ink, first } = strokes;
    let before = -1;
    let x = NaN;
    let y = NaN;
    pen.beginPath();
    for (let index = from - first; index < to - first; index++) {
      const colour = ink[index];
      if (colour !== before) {
        if (before >= 0) pen.stroke();
        pen.beginPath();
        pen.strokeStyle = `rgb(${(colour >> 16) & 255} ${(colour >> 8) & 255} ${colour & 255})`;
        pen.lineWidth = (colour >>> 24 || 1) * SCALE;
        before = colour;
        x = NaN;
      }
      const at = index * 4;
      if (xy[at] !== x || xy[at + 1] !== y) pen.moveTo(place(xy[at]) * SCALE, placeUp(xy[at + 1]) * SCALE);
      x = xy[at + 2];
      y = xy[at + 3];
      pen.lineTo(place(x) * SCALE, placeUp(y) * SCALE);
    }
    if (before >= 0) pen.stroke();
  }
}

// Pictures of turtles, from the drawings of /shapes.json, at the size at which they are shown.
export class Pictures {
  constructor(shapes) {
    this.shapes = shapes;
    this.painted = new Map();
  }

  // The picture numbered `number` for `metre` device pixels per metre; its middle is the turtle's place, it looks to the right.
  get(number, metre) {
    const shape = this.shapes[number % this.shapes.length];
    const known = this.painted.get(shape);
    if (known?.metre === metre) return known.canvas;
    const side = Math.ceil(BOX * metre);
    const canvas = Object.assign(document.createElement("canvas"), { width: side, height: side });
    const pen = canvas.getContext("2d");
    pen.translate(side / 2, side / 2);
    pen.scale(metre, metre);
    for (const { d, fill } of shape.paths) {
      pen.fillStyle = fill;
      pen.fill(new Path2D(d));
    }
    this.painted.set(shape, { metre, canvas });
    return canvas;
  }

  // The colour of a turtle's shell, for marks beside its name.
  shell(number) {
    return this.shapes[number % this.shapes.length].shell;
  }
}

// Draw the paper and the turtles into `pen`, a square of `side` device pixels. `chosen` is the name of the turtle that gets a ring; marks()
// draws what lies between paper and turtles.
export function drawWorld(pen, side, paper, turtles, pictures, chosen, marks = () => {}) {
  const factor = side / SIZE;
  const metre = factor * METRE;
  pen.setTransform(1, 0, 0, 1, 0, 0);
  pen.drawImage(paper.canvas, 0, 0, side, side);
  marks();
  const named = turtles.length > 1;
  for (const turtle of turtles) {
    const { x, y, theta } = turtle;
    if (!(Math.abs(x) < 1e4 && Math.abs(y) < 1e4)) continue;
    const left = place(x) * factor;
    const top = placeUp(y) * factor;
    if (named && turtle.name === chosen) {
      pen.beginPath();
      pen.arc(left, top, metre * 0.62, 0, 2 * Math.PI);
      pen.fillStyle = "rgb(255 255 255 / 0.2)";
      pen.fill();
    }
    const picture = pictures.get(turtle.picture, metre);
    pen.translate(left, top);
    pen.rotate(-(theta || 0));
    pen.drawImage(picture, -picture.width / 2, -picture.height / 2);
    pen.setTransform(1, 0, 0, 1, 0, 0);
  }
}

// Where a point of the canvas, in fractions of its side from its upper left corner, lies in the world.
export const toWorld = (u, v) => ({ x: (u * SIZE - 0.5) / METRE, y: (EDGE - v * SIZE + 0.5) / METRE });
