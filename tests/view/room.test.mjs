// Unit tests of what the robot's room is made of: places, links, motions, pointing, the camera; run by test_page_units.py.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Camera, rayThrough, robotsView, seenAt } from "./space/camera.js";
import { linkPoses, place } from "./space/kinematics.js";
import { along, blend, compose, projection, turned, yaw } from "./space/maths.js";
import { Motion } from "./space/motion.js";
import { NOTHING, bytes, learned } from "./space/news.js";
import { boxAround, firstMet, heightOf, meet, onLevel } from "./space/pointing.js";
import { coloured } from "./space/renderer.js";
import { Sharpness } from "./space/sharpness.js";
import { Surface, VERTEX, addBar, addShape } from "./space/solids.js";

const HERE = [0, 0, 0, 1, 0, 0, 0];
const QUARTER = [0, 0, 0, Math.SQRT1_2, 0, 0, Math.SQRT1_2]; // about z
const near = (one, other, by = 1e-6) => one.forEach((value, index) => assert.ok(Math.abs(value - other[index]) < by, `${one} is not near ${other}`));
const shape = (kind, size, frame = HERE) => ({ kind, size, frame, colour: [1, 0, 0, 1], points: [], triangles: [] });
const link = (name, parent, frame, joint = -1, more = {}) => ({ name, parent, frame, joint, slides: false, axis: [0, 0, 1], shapes: [], ...more });
const state = (name, x, joints = [], more = {}) => ({ name, pose: [x, 0, 0, 1, 0, 0, 0], joints, holder: "", link: "", grip: [], ...more });
const ARM = {
  name: "arm", kind: "robot", cameras: [], opening: 1,
  links: [link("base", -1, HERE), link("upper", 0, [0, 0, 1, 1, 0, 0, 0], 0), link("lift", 1, [1, 0, 0, 1, 0, 0, 0], 1, { slides: true, axis: [0, 0, 1] })],
};
const BALL = { name: "ball", kind: "object", cameras: [], links: [link("", -1, HERE, -1, { shapes: [shape("sphere", [0.1])] })] };

test("a quarter turn takes x to y, and what is at a place in a turned frame is there", () => {
  near(turned(QUARTER, [1, 0, 0]), [0, 1, 0]);
  near(compose([1, 2, 3, ...QUARTER.slice(3)], [1, 0, 0, 1, 0, 0, 0]), [1, 3, 3, ...QUARTER.slice(3)]);
  assert.ok(Math.abs(yaw(QUARTER) - 90) < 1e-9);
  near(blend(HERE, QUARTER, 0.5).slice(3), [Math.cos(Math.PI / 8), 0, 0, Math.sin(Math.PI / 8)]);
  for (const way of [[1, 0, 0], [0, -1, 0], [0.3, -0.2, -0.9], [0, 0, 1], [0, 0, -1]]) near(turned(along(way), [0, 0, Math.hypot(...way)]), way);
});

test("joints turn and slide in the frame of their link, and what is held goes with the hand", () => {
  const poses = linkPoses(ARM, state("arm", 5, [Math.PI / 2, 0.25]));
  near(poses[1], [5, 0, 1, ...QUARTER.slice(3)]);
  near(poses[2].slice(0, 3), [5, 1, 1.25]);
  const things = new Map([["ball", BALL], ["arm", ARM]]);
  const held = state("ball", 9, [], { holder: "arm", link: "lift", grip: [0.5, 0, 0, 1, 0, 0, 0] });
  near(place(things, new Map([["arm", state("arm", 5, [Math.PI / 2, 0.25])], ["ball", held]])).get("ball")[0].slice(0, 3), [5, 1.5, 1.25]);
  near(place(things, new Map([["arm", state("arm", 5, [0, 0])], ["ball", { ...held, link: "none" }]])).get("ball")[0].slice(0, 3), [9, 0, 0]);
  assert.equal(place(things, new Map()).size, 0);
});

test("motions follow each other, each as long as it seems to take", () => {
  const motion = new Motion();
  motion.add([{ seconds: 0, states: [state("arm", 0, [0])] }]);
  motion.add([{ seconds: 1, states: [state("arm", 1, [0])] }, { seconds: 1, states: [state("arm", 1, [2])] }]);
  assert.equal(motion.advance(1000), true);
  motion.advance(1500);
  near(motion.states.get("arm").pose, [0.5, 0, 0, 1, 0, 0, 0]);
  motion.advance(2500);
  near(motion.states.get("arm").joints, [1]);
  near(motion.states.get("arm").pose, [1, 0, 0, 1, 0, 0, 0]);
  motion.advance(3100);
  near(motion.states.get("arm").joints, [2]);
  assert.ok(!motion.moving && !motion.advance(3200));
});

test("many motions are caught up with, and somebody who wants none sees jumps", () => {
  const steps = Array.from({ length: 100 }, (_, number) => ({ seconds: 2, states: [state("arm", number + 1)] }));
  const motion = new Motion();
  motion.add([{ seconds: 0, states: [state("arm", 0)] }, ...steps]);
  let now = 0;
  for (; motion.moving; now += 16) motion.advance(now);
  assert.ok(now < 40_000 && motion.states.get("arm").pose[0] === 100, `${now} ms`);
  const still = new Motion(() => true);
  still.add(steps);
  assert.ok(!still.moving && still.states.get("arm").pose[0] === 100);
  motion.add(steps);
  motion.advance(now);
  assert.ok(motion.hurry() && !motion.moving);
});

test("what is known adds up, and two moments do not change each other", () => {
  const first = learned(NOTHING, { complete: true, things: [ARM, BALL], steps: [{ states: [state("arm", 1), state("ball", 2)] }], marks: [] });
  const second = learned(first, { removed: ["ball"], steps: [{ states: [state("arm", 3)] }], marks: [{ seen: [] }] });
  assert.deepEqual([...first.things.keys()], ["arm", "ball"]);
  assert.deepEqual([...second.things.keys()], ["arm"]);
  assert.deepEqual([first.states.get("arm").pose[0], second.states.get("arm").pose[0]], [1, 3]);
  assert.deepEqual([first.marks, second.marks], [null, { seen: [] }]);
  assert.equal(learned(second, { complete: true }).things.size, 0);
  assert.deepEqual([...bytes(btoa("\x00\x7f\xff"))], [0, 127, 255]);
  assert.deepEqual([...bytes([1, 2])], [1, 2]);
});

test("rays meet the shapes where they are", () => {
  const from = [-5, 0, 0];
  for (const [one, distance] of [[shape("box", [2, 2, 2]), 4], [shape("sphere", [0.5]), 4.5], [shape("cylinder", [0.25, 1]), 4.75]]) {
    const hit = meet(one, from, [1, 0, 0]);
    assert.ok(Math.abs(hit.distance - distance) < 1e-9);
    near(hit.normal, [-1, 0, 0]);
    assert.equal(meet(one, from, [-1, 0, 0]), null);
    assert.equal(meet(one, [-5, 3, 0], [1, 0, 0]), null);
  }
  near(meet(shape("cylinder", [0.25, 1]), [0.1, 0, 5], [0, 0, -1]).normal, [0, 0, 1]);
  const mesh = { ...shape("mesh", [1, 1, 1]), points: [0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3] };
  assert.deepEqual(boxAround(mesh), [[0, 0, 0], [1, 2, 3]]);
  const things = new Map([["ball", BALL], ["arm", ARM]]);
  const placed = place(things, new Map([["ball", state("ball", 2)]]));
  const hit = firstMet({ eye: [0, 0, 0], way: [1, 0, 0] }, things, placed);
  assert.equal(hit.name, "ball");
  near(hit.place, [1.9, 0, 0]);
  assert.equal(firstMet({ eye: [0, 0, 0], way: [1, 0, 0] }, things, placed, "ball"), null);
  near(onLevel({ eye: [0, 0, 2], way: [0, 0.6, -0.8] }, 0), [0, 1.5, 0]);
  assert.equal(onLevel({ eye: [0, 0, 2], way: [0, 0, 1] }, 0), null);
  const bar = { links: [link("", -1, HERE, -1, { shapes: [shape("box", [0.2, 0.2, 2])] })] };
  assert.ok(Math.abs(heightOf(bar, [[0, 0, 5, ...along([1, 0, 0]).slice(3)]]) - 4.9) < 1e-9); // it lies on its side
});

test("the camera goes around its target, and what it sees lies where its rays go", () => {
  const camera = new Camera();
  camera.look([1, 2, 0.5], 4);
  for (const act of [() => {}, () => camera.orbit(0.7, -0.3), () => camera.pan(0.2, 0.1), () => camera.zoom(0.5), () => camera.orbit(0, 99), () => camera.orbit(0, -99)]) {
    act();
    const view = camera.view();
    near(seenAt(view, camera.target, 1.5), [0.5, 0.5]);
    const { eye, way } = rayThrough(view, 0.2, 0.9, 1.5);
    near(seenAt(view, eye.map((value, axis) => value + 3 * way[axis]), 1.5), [0.2, 0.9]);
  }
  camera.zoom(1e9);
  camera.pan(1e9, NaN);
  assert.ok(camera.view().eye.every(Number.isFinite));
  const head = robotsView(HERE, 1);
  near(head.ahead, [0, 0, 1]);
  near(head.up, [0, -1, 0]);
  const matrix = projection(camera.view(), 1.5);
  assert.ok([...matrix].every(Number.isFinite));
});

test("a view of everything has all places in the picture, whatever its shape", () => {
  const places = [[-3, -2, 0], [4, 5, 0.2], [0, 1, 2.5]];
  for (const aspect of [0.5, 1, 2]) {
    const camera = new Camera();
    camera.overview(places, aspect);
    for (const spot of places) for (const part of seenAt(camera.view(), spot, aspect)) assert.ok(part >= 0 && part <= 1, `${part}`);
  }
});

test("surfaces are closed: each edge of a shape belongs to two triangles, which look outwards", () => {
  for (const one of [shape("box", [1, 2, 3]), shape("cylinder", [0.5, 2]), shape("sphere", [1])]) {
    const surface = new Surface(4);
    addShape(surface, one, 7);
    const at = (number) => [...surface.floats.subarray((number * VERTEX) / 4, (number * VERTEX) / 4 + 3)].map((value) => Math.round(value * 1e4) / 1e4 + 0).join(" ");
    const count = new Map();
    for (let first = 0; first < surface.count; first += 3) {
      const corners = [...surface.numbers.subarray(first, first + 3)].map(at);
      if (new Set(corners).size < 3) continue; // at the poles of a ball
      const [a, b, c] = corners.map((corner) => corner.split(" ").map(Number));
      const across = [b[1] - a[1], b[2] - a[2], b[0] - a[0]];
      const over = [c[1] - a[1], c[2] - a[2], c[0] - a[0]];
      const normal = [across[0] * over[1] - across[1] * over[0], across[1] * over[2] - across[2] * over[1], across[2] * over[0] - across[0] * over[2]];
      assert.ok(normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2] > 0, `${one.kind}: ${corners}`);
      for (const [from, to] of [[0, 1], [1, 2], [2, 0]]) count.set(`${corners[from]}>${corners[to]}`, 1);
    }
    for (const edge of count.keys()) assert.ok(count.has(edge.split(">").reverse().join(">")), `${one.kind}: ${edge}`);
  }
  const surface = new Surface(4);
  addBar(surface, [0, 0, 0], [1, 1, 1], 0.1, [1, 1, 1]);
  addBar(surface, [0, 0, 0], [0, 0, 0], 0.1, [1, 1, 1]);
  assert.equal(surface.count, 36);
});

test("a mesh has edges where it bends, and none within a plane", () => {
  const points = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1];
  const flat = new Surface();
  addShape(flat, { ...shape("mesh", [1, 1, 1]), points, triangles: [0, 1, 2, 0, 2, 3] }, 0);
  const bent = new Surface();
  addShape(bent, { ...shape("mesh", [1, 1, 1]), points, triangles: [0, 1, 2, 0, 2, 4] }, 0);
  const edges = (surface) => Array.from({ length: surface.vertices }, (_, number) => surface.floats.subarray(number * 12 + 8, number * 12 + 12)).some((rim) => rim.includes(0));
  assert.deepEqual([edges(flat), edges(bent)], [false, true]);
});

test("a costmap is clear where it is nothing, and brightest where it is greatest", () => {
  const made = coloured({ cells: [0, 128, 255] });
  assert.equal(made[3], 0);
  assert.ok(made[7] > 0 && made[9] > made[5] && made[8] > made[4]);
});

test("a slow browser gets fewer pixels while the picture moves, and all of them when it rests", () => {
  const sharpness = new Sharpness(() => 1);
  let now = 0;
  for (let frame = 0; frame < 100; frame++) sharpness.at((now += 80), true);
  assert.equal(sharpness.at(now + 10, true), 0.5);
  assert.deepEqual([sharpness.at(now + 100, false), sharpness.at(now + 300, false), sharpness.at(now + 500, false)], [0, 2, 0]);
  for (let frame = 0; frame < 200; frame++) sharpness.at((now += 17), true);
  assert.equal(sharpness.at(now + 17, true), 1);
});
