// The surfaces of shapes, as numbers for WebGL. A vertex has a place and a normal in the frame of its link, the number of its bone (the link
// that moves it), a colour, and its rim: how far it is from up to four edges of its side, so that edges can be drawn where that is nothing.

import { add, along, cross, dot, length, minus, times, turned, unit } from "./maths.js";
import { boxAround } from "./pointing.js";

export const VERTEX = 48; // bytes: 3 floats, 3 floats, 1 float, 4 bytes, 4 floats
const COLOUR = 28; // where the bytes are
const SIDES = 20; // of the polygon that stands for a circle
const RINGS = 10; // of a ball
const CREASE = 0.8; // cosine of the angle from which on two triangles of a mesh meet in an edge
const FAR = 1e3; // from an edge that there is not
const NO_EDGE = [FAR, FAR, FAR, FAR];
const FACES = [ // of a box: the axis across, its side, and the two axes along
  [0, 1, 1, 2], [0, -1, 2, 1], [1, 1, 2, 0], [1, -1, 0, 2], [2, 1, 0, 1], [2, -1, 1, 0],
];

// Vertices, and the triangles between them; both grow.
export class Surface {
  constructor(room = 512) {
    this.clear();
    this.#grow(room);
  }

  #grow(room) {
    const { bytes, numbers } = this;
    this.room = room;
    this.bytes = new Uint8Array(room * VERTEX);
    this.floats = new Float32Array(this.bytes.buffer);
    this.numbers = new Uint32Array(room * 3); // a solid has at most twice as many triangles as vertices, and few have
    if (bytes) this.bytes.set(bytes);
    if (numbers) this.numbers.set(numbers);
  }

  clear() {
    this.vertices = this.count = 0; // count: of the numbers of vertices that make the triangles
  }

  // Add a vertex; its number.
  add(place, normal, colour, bone = 0, rim = NO_EDGE) {
    if (this.vertices === this.room) this.#grow(this.room * 2);
    const at = this.vertices * VERTEX;
    this.floats.set([place[0], place[1], place[2], normal[0], normal[1], normal[2], bone], at / 4);
    for (let part = 0; part < 4; part++) this.bytes[at + COLOUR + part] = Math.round(255 * Math.max(0, Math.min(1, colour[part] ?? 1)));
    this.floats.set(rim, at / 4 + 8);
    return this.vertices++;
  }

  triangle(a, b, c) {
    if (this.count + 3 > this.numbers.length) this.#grow(this.room * 2);
    this.numbers.set([a, b, c], this.count);
    this.count += 3;
  }

  // a, b, c, d: around, against the clock as it is seen from outside.
  quad(a, b, c, d) {
    this.triangle(a, b, c);
    this.triangle(a, c, d);
  }
}

// Add a shape to `surface`.
export function addShape(surface, shape, bone) {
  const { frame, colour } = shape;
  const put = (place, normal, rim) => surface.add(add(frame, turned(frame, place)), turned(frame, normal), colour, bone, rim);
  MAKERS[shape.kind]?.(surface, shape, put);
}

const MAKERS = { box: addBox, cylinder: addCylinder, sphere: addBall, mesh: addMesh };

function addBox(surface, { size }, put) {
  const half = times(size, 0.5);
  for (const [axis, side, one, other] of FACES) {
    const normal = [0, 0, 0];
    normal[axis] = side;
    const [wide, high] = [size[one], size[other]];
    surface.quad(...[[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
      const at = [0, 0, 0];
      at[axis] = side * half[axis];
      at[one] = a * half[one];
      at[other] = b * half[other];
      return put(at, normal, [a > 0 ? wide : 0, a > 0 ? 0 : wide, b > 0 ? high : 0, b > 0 ? 0 : high]);
    }));
  }
}

const circle = (number, radius = 1) => {
  const angle = (2 * Math.PI * number) / SIDES;
  return [radius * Math.cos(angle), radius * Math.sin(angle)];
};

function addCylinder(surface, { size: [radius, tall] }, put) {
  const half = tall / 2;
  const [low, high] = [-1, 1].map((side) => Array.from({ length: SIDES }, (_, number) =>
    put([...circle(number, radius), side * half], [...circle(number), 0], [side > 0 ? tall : 0, side > 0 ? 0 : tall, FAR, FAR])));
  for (const side of [1, -1]) {
    const middle = put([0, 0, side * half], [0, 0, side], [radius, FAR, FAR, FAR]);
    const rim = Array.from({ length: SIDES }, (_, number) => put([...circle(number, radius), side * half], [0, 0, side], [0, FAR, FAR, FAR]));
    rim.forEach((one, number) => {
      const next = rim[(number + 1) % SIDES];
      surface.triangle(middle, ...(side > 0 ? [one, next] : [next, one]));
    });
  }
  for (let number = 0; number < SIDES; number++) {
    const next = (number + 1) % SIDES;
    surface.quad(low[number], low[next], high[next], high[number]);
  }
}

function addBall(surface, { size: [radius] }, put) {
  const rings = Array.from({ length: RINGS + 1 }, (_, ring) => Array.from({ length: SIDES }, (__, number) => {
    const down = (Math.PI * ring) / RINGS;
    const way = [...circle(number, Math.sin(down)), Math.cos(down)];
    return put(times(way, radius), way);
  }));
  for (let ring = 0; ring < RINGS; ring++) {
    for (let number = 0; number < SIDES; number++) {
      const next = (number + 1) % SIDES;
      surface.quad(rings[ring][number], rings[ring + 1][number], rings[ring + 1][next], rings[ring][next]);
    }
  }
}

// Which side of a triangle is outside is not known for certain, so it gets two.
function addMesh(surface, shape, put) {
  const { points, triangles } = shape;
  if (!triangles.length) { // only points are known: the box around them
    const [low, high] = boxAround(shape);
    const middle = times(add(low, high), 0.5);
    addBox(surface, { size: minus(high, low) }, (place, ...more) => put(add(middle, place), ...more));
    return;
  }
  const at = (number) => points.slice(3 * number, 3 * number + 3);
  const creases = creasesOf(triangles, at);
  for (let first = 0; first + 2 < triangles.length; first += 3) {
    const numbers = [triangles[first], triangles[first + 1], triangles[first + 2]];
    const places = numbers.map(at);
    const normal = unit(cross(minus(places[1], places[0]), minus(places[2], places[0])));
    for (const side of [1, -1]) {
      const corners = places.map((place, corner) => put(place, times(normal, side), [...[0, 1, 2].map((edge) => {
        const [one, other] = [edge, (edge + 1) % 3];
        if (!creases.has(edgeOf(numbers[one], numbers[other]))) return FAR;
        return corner === one || corner === other ? 0 : farFrom(place, places[one], places[other]);
      }), FAR]));
      surface.triangle(corners[0], ...(side > 0 ? [corners[1], corners[2]] : [corners[2], corners[1]]));
    }
  }
}

const edgeOf = (one, other) => (one < other ? `${one} ${other}` : `${other} ${one}`);

// How far a place is from the line through two others.
function farFrom(place, one, other) {
  const way = unit(minus(other, one));
  const aside = minus(place, one);
  return length(minus(aside, times(way, dot(aside, way))));
}

// The edges of a mesh at which it bends.
function creasesOf(triangles, at) {
  const normals = new Map();
  const found = new Set();
  for (let first = 0; first + 2 < triangles.length; first += 3) {
    const numbers = [triangles[first], triangles[first + 1], triangles[first + 2]];
    const [a, b, c] = numbers.map(at);
    const normal = unit(cross(minus(b, a), minus(c, a)));
    for (let edge = 0; edge < 3; edge++) {
      const key = edgeOf(numbers[edge], numbers[(edge + 1) % 3]);
      const across = normals.get(key);
      if (!across) normals.set(key, normal);
      else if (dot(across, normal) < CREASE) found.add(key);
    }
  }
  return found;
}

// Add a bar between two places to `surface`, so many metres thick.
export function addBar(surface, from, to, thick, colour) {
  const way = minus(to, from);
  const long = length(way);
  if (!(long > 1e-6)) return;
  const frame = [...times(add(from, to), 0.5), ...along(way).slice(3)];
  addBox(surface, { size: [thick, thick, long] }, (place, normal) => surface.add(add(frame, turned(frame, place)), turned(frame, normal), colour));
}
