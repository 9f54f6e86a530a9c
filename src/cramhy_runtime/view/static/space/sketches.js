// What is drawn beside the things themselves: the frames of links, where the robot has driven, the poses to which its tools were to go, and
// how far an object is from where it is believed to be. All of it is bars.

import { add, length, minus, turned } from "./maths.js";
import { addBar } from "./solids.js";

const AXES = [[[1, 0, 0], [0.85, 0.2, 0.15]], [[0, 1, 0], [0.15, 0.6, 0.2]], [[0, 0, 1], [0.2, 0.35, 0.9]]];
const FRAME = { robot: [0.09, 0.007], object: [0.1, 0.008], furniture: [0.09, 0.007], room: [0.4, 0.014] }; // long, thick, m
const NEAREST = 0.3; // m
const PATH = [[0.1, 0.45, 0.95], 0.035, 0.02]; // colour, thick, height
const GOOD = [0.1, 0.65, 0.3];
const BAD = [0.85, 0.15, 0.1];
const HAND = [[[-0.11, 0, 0], [-0.05, 0, 0]], [[-0.05, -0.045, 0], [-0.05, 0.045, 0]], [[-0.05, 0.045, 0], [0.015, 0.045, 0]], [[-0.05, -0.045, 0], [0.015, -0.045, 0]]];

export function addFrame(surface, pose, [long, thick]) {
  for (const [axis, colour] of AXES) addBar(surface, pose, add(pose, turned(pose, axis.map((part) => part * long))), thick, colour);
}

// The frames of the room, of objects, and of those links that have a shape or a camera; none before the very `eye`.
export function addFrames(surface, things, placed, eye) {
  addFrame(surface, [0, 0, 0, 1, 0, 0, 0], FRAME.room);
  for (const [name, { kind, links, cameras }] of things) {
    if (kind !== "robot" && kind !== "object") continue;
    placed.get(name)?.forEach((pose, number) => {
      if (length(minus(pose, eye)) < NEAREST) return;
      if (links[number].shapes.length || cameras.includes(links[number].name)) addFrame(surface, pose, FRAME[kind]);
    });
  }
}

// ways: for each robot the places [x, y] where its base has been.
export function addPaths(surface, ways) {
  const [colour, thick, z] = PATH;
  for (const way of ways.values()) {
    for (let number = 1; number < way.length; number++) {
      addBar(surface, [...way[number - 1], z], [...way[number], z], thick, colour);
    }
    if (way.length > 1) for (const [x, y] of way) addBar(surface, [x, y, 0], [x, y, 0.05], thick * 1.7, colour);
  }
}

// WorldPoses of tools: a little hand for each, green where it was reached, red where not; the newest is the thickest.
export function addGrasps(surface, grasps) {
  grasps.forEach(({ pose, good }, number) => {
    const thick = number === grasps.length - 1 ? 0.014 : 0.007;
    for (const [one, other] of HAND) {
      addBar(surface, add(pose, turned(pose, one)), add(pose, turned(pose, other)), thick, good ? GOOD : BAD);
    }
  });
}

export function addOffset(surface, from, to, colour) {
  if (Math.hypot(...minus(from, to)) > 0.02) addBar(surface, from, to, 0.006, colour);
}
