// What a ray meets: shapes are asked in their own frames. Of a mesh the box around it counts.

import { add, compose, dot, minus, times, turned, turnedBack } from "./maths.js";

const SLIGHT = 1e-9;

// The first of `things` that a ray meets: {name, link, distance, place, normal}, or null. placed: name → poses of links.
export function firstMet({ eye, way }, things, placed, but = null) {
  let found = null;
  for (const [name, thing] of things) {
    const poses = placed.get(name);
    if (name === but || !poses) continue;
    thing.links.forEach((link, number) => {
      for (const shape of link.shapes) {
        const pose = compose(poses[number], shape.frame);
        const hit = meet(shape, turnedBack(pose, minus(eye, pose)), turnedBack(pose, way));
        if (hit && hit.distance > 0.02 && (!found || hit.distance < found.distance)) {
          found = { name, link: number, distance: hit.distance, normal: turned(pose, hit.normal) };
        }
      }
    });
  }
  return found && { ...found, place: add(eye, times(way, found.distance)) };
}

// Where a ray meets the level plane at the height `z`, or null.
export function onLevel({ eye, way }, z) {
  const distance = (z - eye[2]) / way[2];
  return distance > 0 && distance < 100 ? add(eye, times(way, distance)) : null;
}

// {distance, normal} of a shape in its own frame, or null.
export function meet(shape, eye, way) {
  const { kind, size } = shape;
  if (kind === "box") return meetBox(times(size, -0.5), times(size, 0.5), eye, way);
  if (kind === "sphere") return meetBall(size[0], eye, way);
  if (kind === "cylinder") return meetCylinder(size[0], size[1] / 2, eye, way);
  if (kind === "plane") return meetFloor(eye, way);
  const [low, high] = boxAround(shape);
  return meetBox(low, high, eye, way);
}

// The corners of the box around a shape, in its own frame.
export function boxAround({ kind, size, points }) {
  if (kind === "box") return [times(size, -0.5), times(size, 0.5)];
  if (kind === "sphere") return [[-size[0], -size[0], -size[0]], [size[0], size[0], size[0]]];
  if (kind === "cylinder") return [[-size[0], -size[0], -size[1] / 2], [size[0], size[0], size[1] / 2]];
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let index = 0; index < points.length; index++) {
    low[index % 3] = Math.min(low[index % 3], points[index]);
    high[index % 3] = Math.max(high[index % 3], points[index]);
  }
  return points.length >= 3 ? [low, high] : [[0, 0, 0], [0, 0, 0]];
}

function meetBox(low, high, eye, way) {
  let [enter, leave] = [-Infinity, Infinity];
  let normal = [0, 0, 1];
  for (let axis = 0; axis < 3; axis++) {
    if (Math.abs(way[axis]) < SLIGHT) {
      if (eye[axis] < low[axis] || eye[axis] > high[axis]) return null;
      continue;
    }
    const toLow = (low[axis] - eye[axis]) / way[axis];
    const toHigh = (high[axis] - eye[axis]) / way[axis];
    if (Math.min(toLow, toHigh) > enter) {
      enter = Math.min(toLow, toHigh);
      normal = [0, 1, 2].map((one) => (one === axis ? -Math.sign(way[axis]) : 0));
    }
    leave = Math.min(leave, Math.max(toLow, toHigh));
  }
  return leave >= enter && enter > 0 ? { distance: enter, normal } : null;
}

function meetBall(radius, eye, way) {
  const b = dot(eye, way);
  const root = b * b - dot(eye, eye) + radius * radius;
  if (root < 0) return null;
  const distance = -b - Math.sqrt(root);
  return distance > 0 ? { distance, normal: times(add(eye, times(way, distance)), 1 / radius) } : null;
}

function meetCylinder(radius, half, eye, way) {
  let found = null;
  const a = way[0] * way[0] + way[1] * way[1];
  const b = eye[0] * way[0] + eye[1] * way[1];
  const root = b * b - a * (eye[0] * eye[0] + eye[1] * eye[1] - radius * radius);
  if (a > SLIGHT && root >= 0) {
    const distance = (-b - Math.sqrt(root)) / a;
    const [x, y, z] = add(eye, times(way, distance));
    if (distance > 0 && Math.abs(z) <= half) found = { distance, normal: [x / radius, y / radius, 0] };
  }
  if (Math.abs(way[2]) > SLIGHT) {
    const side = -Math.sign(way[2]);
    const distance = (side * half - eye[2]) / way[2];
    const [x, y] = add(eye, times(way, distance));
    if (distance > 0 && x * x + y * y <= radius * radius && (!found || distance < found.distance)) {
      found = { distance, normal: [0, 0, side] };
    }
  }
  return found;
}

function meetFloor(eye, way) {
  const distance = -eye[2] / way[2];
  return distance > 0 && distance < 100 ? { distance, normal: [0, 0, eye[2] > 0 ? 1 : -1] } : null;
}

export const heightOf = (thing, poses) => {
  let lowest = Infinity;
  thing.links.forEach((link, number) => {
    for (const shape of link.shapes) {
      const [low, high] = boxAround(shape);
      const pose = compose(poses[number], shape.frame);
      const middle = add(pose, turned(pose, times(add(low, high), 0.5)));
      const half = times(minus(high, low), 0.5);
      const z = [[half[0], 0, 0], [0, half[1], 0], [0, 0, half[2]]].reduce((sum, edge) => sum + Math.abs(turned(pose, edge)[2]), 0);
      lowest = Math.min(lowest, middle[2] - z);
    }
  });
  return Number.isFinite(lowest) ? lowest : 0;
};
