// The eye that the world is seen with: it looks at a target from a distance, and goes around it. Angles are radians, lengths metres.

import { add, cross, dot, length, minus, times, turned, unit } from "./maths.js";

export const OPENING = (50 * Math.PI) / 180;
const STEEPEST = (88 * Math.PI) / 180;
const NEAREST = 0.25;
const FARTHEST = 40;
const SIDE = [-0.6, -0.5, 0.72]; // from where a world is seen when nobody says from where
const MARGIN = 1.04;
const REACH = 30; // m from the middle of the world that the target may be

export class Camera {
  constructor() {
    this.look([0, 0, 0.5], 6);
  }

  // Look at `target` from the usual side.
  look(target, distance) {
    this.target = target;
    this.azimuth = Math.atan2(SIDE[1], SIDE[0]);
    this.elevation = Math.asin(SIDE[2] / length(SIDE));
    this.distance = distance;
    this.#keepIn();
  }

  // Have all of these places in the picture.
  overview(places, aspect) {
    const [low, high] = [Math.min, Math.max].map((most) =>
      [0, 1, 2].map((axis) => places.reduce((value, place) => most(value, place[axis]), places[0][axis])));
    this.look(times(add(low, high), 0.5), 1);
    const middle = this.target;
    const { right, up, ahead } = this.view();
    const half = Math.tan(OPENING / 2);
    let away = NEAREST;
    for (const place of places) {
      const at = minus(place, middle);
      away = Math.max(away, Math.max(Math.abs(dot(at, right)) / (half * aspect), Math.abs(dot(at, up)) / half) - dot(at, ahead));
    }
    this.distance = away * MARGIN;
    this.#keepIn();
  }

  // Begin where another view is, with what is `distance` ahead of it as the target.
  from({ eye, ahead }, distance = 1.5) {
    this.target = add(eye, times(ahead, distance));
    this.azimuth = Math.atan2(-ahead[1], -ahead[0]);
    this.elevation = Math.asin(Math.max(-1, Math.min(1, -ahead[2])));
    this.distance = distance;
    this.#keepIn();
  }

  orbit(around, over) {
    this.azimuth += around;
    this.elevation += over;
    this.#keepIn();
  }

  // Move the target by parts of the picture's height, to the right and up.
  pan(right, up) {
    const view = this.view();
    const high = 2 * this.distance * Math.tan(OPENING / 2);
    this.target = add(this.target, add(times(view.right, right * high), times(view.up, up * high)));
    this.#keepIn();
  }

  zoom(factor) {
    this.distance *= factor;
    this.#keepIn();
  }

  view() {
    const flat = Math.cos(this.elevation);
    const back = [flat * Math.cos(this.azimuth), flat * Math.sin(this.azimuth), Math.sin(this.elevation)];
    const ahead = times(back, -1);
    const right = unit(cross(ahead, [0, 0, 1]));
    return { eye: add(this.target, times(back, this.distance)), right, up: cross(right, ahead), ahead, opening: OPENING };
  }

  #keepIn() {
    const within = (value, low, high) => (Number.isFinite(value) ? Math.max(low, Math.min(high, value)) : low);
    this.elevation = within(this.elevation, -STEEPEST, STEEPEST);
    this.distance = within(this.distance, NEAREST, FARTHEST);
    this.target = this.target.map((value) => within(value, -REACH, REACH));
  }
}

// What a robot sees with a camera whose link is at `pose`: along z, x to the right, y down.
export const robotsView = (pose, opening) => ({
  eye: pose.slice(0, 3), right: turned(pose, [1, 0, 0]), up: turned(pose, [0, -1, 0]), ahead: turned(pose, [0, 0, 1]), opening,
});

export const corners = (low, high) =>
  Array.from({ length: 8 }, (_, number) => [0, 1, 2].map((axis) => ((number >> axis) & 1 ? high[axis] : low[axis])));

// The ray {eye, way} through the point (u, v) of the picture: fractions of its width and height, from the upper left corner.
export function rayThrough({ eye, right, up, ahead, opening }, u, v, aspect) {
  const half = Math.tan(opening / 2);
  const aside = add(times(right, (2 * u - 1) * half * aspect), times(up, (1 - 2 * v) * half));
  return { eye, way: unit(add(ahead, aside)) };
}

// Where a place is seen: [u, v] as above, or null when it is behind the eye.
export function seenAt({ eye, right, up, ahead, opening }, place, aspect) {
  const at = minus(place, eye);
  const depth = dot(at, ahead);
  if (depth < 1e-3) return null;
  const half = Math.tan(opening / 2) * depth;
  return [(dot(at, right) / (half * aspect) + 1) / 2, (1 - dot(at, up) / half) / 2];
}
