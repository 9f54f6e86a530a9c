// What is known of the robot's world at one moment: things (WorldThing by name), states (where they are, WorldState by name) and marks
// (WorldMarks, or null). Messages are never changed, so two moments share what is the same in both.

export const NOTHING = Object.freeze({ things: new Map(), states: new Map(), marks: null });

// What is known after a RobotWorld, `message`, if `before` was known.
export function learned(before, message) {
  const base = message.complete ? NOTHING : before;
  const removed = message.removed ?? [];
  const known = { things: base.things, states: base.states, marks: message.marks?.[0] ?? base.marks };
  if (removed.length || message.things?.length) {
    known.things = new Map(base.things);
    for (const name of removed) known.things.delete(name);
    for (const thing of message.things ?? []) known.things.set(thing.name, thing);
  }
  if (removed.length || message.steps?.length) {
    known.states = new Map(base.states);
    for (const name of removed) known.states.delete(name);
    for (const { states } of message.steps ?? []) for (const state of states) known.states.set(state.name, state);
  }
  return known;
}

// Numbers from 0 to 255, which come as a list or, as rosbridge has it, in base64.
export function bytes(values) {
  if (typeof values !== "string") return Uint8Array.from(values);
  return Uint8Array.from(atob(values), (letter) => letter.charCodeAt(0));
}
