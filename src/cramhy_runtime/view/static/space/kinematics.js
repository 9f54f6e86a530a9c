// Where the links of things are, from where their roots are and how far their joints have gone; and what is held, which goes with its link.

import { NOWHERE, compose, times, turnAbout } from "./maths.js";

// The poses of the links of `thing` (a WorldThing) with the `state` {pose, joints}, in the order of the links.
export function linkPoses(thing, { pose, joints }) {
  const poses = [];
  for (const { parent, frame, joint, slides, axis } of thing.links) {
    let at = parent < 0 ? pose : compose(poses[parent] ?? NOWHERE, frame);
    if (joint >= 0) {
      const value = joints[joint] ?? 0;
      at = compose(at, slides ? [...times(axis, value), 1, 0, 0, 0] : turnAbout(axis, value));
    }
    poses.push(at);
  }
  return poses;
}

// name → poses of links, of all `things` (Map name → WorldThing) that have a state in `states` (Map name → WorldState).
export function place(things, states) {
  const placed = new Map();
  const held = [];
  for (const [name, thing] of things) {
    const state = states.get(name);
    if (!state) continue;
    if (state.holder && things.has(state.holder)) held.push([name, thing, state]);
    else placed.set(name, linkPoses(thing, state));
  }
  for (const [name, thing, state] of held) {
    const link = things.get(state.holder).links.findIndex((one) => one.name === state.link);
    const hand = placed.get(state.holder)?.[link];
    placed.set(name, linkPoses(thing, hand && state.grip.length === 7 ? { ...state, pose: compose(hand, state.grip) } : state));
  }
  return placed;
}
