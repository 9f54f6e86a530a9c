// Unit tests of the page's modules that touch no document; run by test_page_units.py with `node --test`.

import assert from "node:assert/strict";
import { test } from "node:test";

import { Connection } from "./connection.js";
import { clock, decimal, duration, grouped, shortName } from "./format.js";
import { History } from "./history.js";
import { foremost, outline } from "./outline.js";
import { Playback, between } from "./playback.js";
import { Series, WINDOW, numberOf } from "./series.js";
import { Session } from "./session.js";
import { State } from "./state.js";
import { Strokes } from "./strokes.js";
import { Way } from "./way.js";

// A connection that is left alone tries again for ever; node shall not wait for that.
const { setTimeout: set } = globalThis;
globalThis.setTimeout = (...of) => set(...of).unref();

// ------------------------------------------------------------------------------------------------------------------ helpers

const turtle = (x, more = {}) => ({ name: "turtle1", x, y: 1, theta: 0, ...more });
const tick = (stamp, x, more) => ({ stamp, turtles: [turtle(x, more)], strokes: Math.round(stamp * 100), epoch: null });
const line = (x1, x2 = x1 + 1) => ({ x1, y1: 0, x2, y2: 0, r: 1, g: 2, b: 3, width: 4 });
const world = (stamp, clears, strokes, more = {}) => ({ stamp, clears, r: 69, g: 86, b: 255, turtles: [turtle(stamp)], strokes, ...more });
const task = (id, parent = "", state = "RUNNING") => ({
  id, parent, name: id, operator: "", state, waits_for: "", place: "", began: 0, ended: null, result: "",
});
const treeOf = (...tasks) => new Map(tasks.map((one) => [one.id, one]));

class FakeSocket {
  sent = [];
  send(text) {
    this.sent.push(JSON.parse(text));
  }
  hear(message) {
    this.onmessage({ data: JSON.stringify(message) });
  }
  close() {
    this.closed = true;
  }
}

function connected(options = {}) {
  const sockets = [];
  const states = [];
  const connection = new Connection({ url: "ws://x", token: "t", changed: (state) => states.push(state), make: () => {
    sockets.push(new FakeSocket());
    return sockets.at(-1);
  }, ...options });
  connection.connect();
  return { connection, sockets, states };
}

// ---------------------------------------------------------------------------------------------------------------- playback

test("between two ticks a turtle is on the straight line", () => {
  const seen = between(tick(1, 2), tick(2, 2.5), 0.5);
  assert.equal(seen.turtles[0].x, 2.25);
  assert.equal(seen.stamp, 1.5);
});

test("a heading turns the short way round", () => {
  const seen = between(tick(0, 1, { theta: 3 }), tick(1, 1, { theta: -3 }), 0.5);
  assert.ok(Math.abs(Math.abs(seen.turtles[0].theta) - Math.PI) < 1e-9);
});

test("a teleport is not a move, and neither is a coordinate that is no number", () => {
  assert.equal(between(tick(0, 1), tick(1, 9), 0.5).turtles[0].x, 1);
  assert.equal(between(tick(0, 1), tick(1, NaN), 0.5).turtles[0].x, 1);
});

test("ticks that come in clumps are shown evenly", () => {
  const playback = new Playback(60);
  for (let index = 0; index < 40; index++) playback.push(tick(index * 0.016, index * 0.016), 1000 + Math.floor(index / 4) * 64 + 48);
  const places = [];
  for (let now = 1300; now < 1500; now += 16) places.push(playback.at(now).turtles[0].x);
  const steps = places.slice(1).map((place, index) => place - places[index]);
  assert.ok(Math.min(...steps) > 0.009 && Math.max(...steps) < 0.023, String(steps));
});

test("where plan time jumps, ticks are shown as they come", () => {
  const playback = new Playback(50);
  playback.rate = 0;
  playback.push(tick(0, 1), 1000);
  playback.push(tick(500, 2), 1010);
  assert.equal(playback.at(1049).turtles[0].x, 1);
  assert.equal(playback.at(1060).turtles[0].x, 2);
});

test("a screen that does not come to draw does not make the queue grow", () => {
  const playback = new Playback();
  for (let index = 0; index < 5000; index++) playback.push(tick(index * 0.016, 1), index * 16);
  assert.ok(playback.samples.length <= 240);
});

// ----------------------------------------------------------------------------------------------------------------- strokes

test("the paper is known at each moment", () => {
  const strokes = new Strokes();
  strokes.add(world(1, 1, [line(0)], { complete: true }));
  strokes.add(world(2, 1, [line(1), line(2)]));
  strokes.add(world(3, 2, [line(3)]));
  assert.equal(strokes.at(1.5).strokes, 1);
  assert.equal(strokes.at(2).strokes, 3);
  assert.deepEqual([strokes.at(2).epoch.start, strokes.at(3).epoch.start, strokes.at(3).strokes], [0, 3, 4]);
});

test("lines of an earlier time take the place of those whose times were not known", () => {
  const strokes = new Strokes();
  strokes.add(world(10, 2, [line(5), line(6)], { complete: true })); // drawn at 8 and 9
  const late = strokes.add(world(11, 2, [line(7)]));
  const older = new Strokes();
  older.add(world(5, 1, [line(1)], { complete: true }));
  for (const message of [world(6, 1, [line(2)]), world(7, 2, []), world(8, 2, [line(5)]), world(9, 2, [line(6)])]) older.add(message);
  strokes.prepend(older);
  assert.equal(strokes.at(11).strokes, late.strokes);
  assert.equal(strokes.at(11).epoch, late.epoch);
  const places = (stamp) => {
    const { strokes: end, epoch } = strokes.at(stamp);
    return Array.from({ length: end - epoch.start }, (_, index) => strokes.xy[(epoch.start - strokes.first + index) * 4]);
  };
  assert.deepEqual([5, 6, 7, 8, 9, 10, 11].map(places), [[1], [1, 2], [], [5], [5, 6], [5, 6], [5, 6, 7]]);
  assert.equal(strokes.start, 5);
});

test("a complete world is a clean paper", () => {
  const strokes = new Strokes();
  strokes.add(world(1, 1, [line(0)], { complete: true }));
  const { strokes: end, epoch } = strokes.add(world(2, 1, [line(0)], { complete: true }));
  assert.deepEqual([epoch.start, end], [1, 2]);
});

test("lines that were given up leave the others and their times alone", () => {
  const strokes = new Strokes(8);
  for (let index = 0; index < 9; index++) strokes.add(world(index, 1, [line(index)]));
  assert.ok(strokes.full);
  strokes.drop(3);
  assert.deepEqual([strokes.first, strokes.end, strokes.start, strokes.at(5).strokes], [3, 9, 2, 6]);
  assert.equal(strokes.xy[0], 3);
  assert.equal(strokes.epochOf(9), strokes.epochs[0]);
});

// ----------------------------------------------------------------------------------------------------------------- history

test("any moment is found again", () => {
  const history = new History();
  for (let index = 0; index < 1000; index++) {
    history.add("tasks", { stamp: index, tasks: [task(`t${index}`)], removed: index > 9 ? [`t${index - 10}`] : [] });
  }
  for (const stamp of [0, 3, 255, 256, 257, 600.5, 999]) {
    assert.equal([...history.at(stamp).tasks.keys()].at(-1), `t${Math.floor(stamp)}`);
    assert.equal(history.at(stamp).stamp, stamp);
  }
  assert.equal(history.at(600).tasks.size, 10);
  assert.equal(history.live.tasks.size, 10);
});

test("looking back does not change the present", () => {
  const history = new History();
  history.add("tasks", { stamp: 1, tasks: [task("a")], removed: [] });
  history.add("tasks", { stamp: 2, tasks: [task("b")], removed: ["a"] });
  history.at(1).apply("tasks", { stamp: 9, tasks: [task("c")], removed: [] });
  assert.deepEqual([...history.live.tasks.keys()], ["b"]);
  assert.deepEqual([...history.at(1).tasks.keys()], ["a"]);
  assert.equal(history.end, 2);
});

test("what is remembered is bounded by what it holds, and the newest is kept", () => {
  const history = new History(2000);
  for (let index = 0; index < 20_000; index++) {
    history.add("fluents", { stamp: index, fluents: [{ id: "f", value: String(index) }], removed: [] });
  }
  assert.ok(history.cost <= 2000, String(history.cost));
  assert.ok(history.start > 18_000);
  assert.equal(history.at(19_999).fluents.get("f").value, "19999");
  assert.equal(history.at(5).fluents.get("f").value, history.at(history.start).fluents.get("f").value);
});

test("of poses that follow each other closely the last is kept", () => {
  const history = new History();
  for (let index = 0; index <= 100; index++) history.add("world", { stamp: index * 0.01, turtles: [turtle(index)] });
  assert.equal(history.at(1).world.turtles[0].x, 100);
  assert.ok([...history.between("world", 0, 1)].length < 60);
});

test("what was told between two moments is found without reading all that was before", () => {
  const history = new History();
  for (let index = 0; index < 1000; index++) history.add("fluents", { stamp: index, fluents: [], removed: [] });
  history.add("tasks", { stamp: 1000, tasks: [], removed: [] });
  for (const [start, end] of [[-5, 3], [255, 257], [256, 256], [700, 2000]]) {
    const stamps = [...history.between("fluents", start, end)].map(({ stamp }) => stamp);
    assert.deepEqual([stamps[0], stamps.at(-1)], [Math.max(start, 0), Math.min(end, 999)]);
    assert.equal(stamps.length, stamps.at(-1) - stamps[0] + 1);
  }
});

test("a chapter of the past comes before what is known", () => {
  const history = new History();
  history.restart(new State().apply("tasks", { stamp: 10, tasks: [task("now")], removed: [] }));
  history.add("modules", { stamp: 10, modules: [] });
  const before = new History();
  before.add("tasks", { stamp: 1, tasks: [task("old")], removed: [] });
  history.prepend(before.live, [{ kind: "tasks", message: { stamp: 5, tasks: [task("middle")], removed: [] } }]);
  assert.deepEqual([1, 5, 10].map((stamp) => [...history.at(stamp).tasks.keys()]), [["old"], ["old", "middle"], ["now"]]);
  assert.equal(history.start, 1);
});

// ----------------------------------------------------------------------------------------------------------------- outline

test("living tasks are open, and dead plans closed but for the last, which is open down to what failed", () => {
  const dead = (id, parent, began, ended) => ({ ...task(id, parent, "SUCCEEDED"), began, ended });
  const rows = outline(treeOf(dead("a", "", 0, 1), dead("a1", "a", 0, 1), dead("b", "", 2, 4), dead("b1", "b", 2, 4), dead("beside", "", 3, 4)));
  assert.deepEqual(rows.map(({ key, level }) => [key, level]), [["beside", 1], ["b", 1], ["b1", 2], ["a", 1]]);
  const live = outline(treeOf(task("a"), task("a1", "a"), task("b")));
  assert.deepEqual(live.map(({ key }) => key), ["b", "a", "a1"]);
  const failed = outline(treeOf(
    dead("c", "", 5, 9), dead("c1", "c", 5, 6), dead("c11", "c1", 5, 6), dead("c2", "c", 6, 9), { ...dead("c21", "c2", 6, 9), state: "FAILED" },
  ));
  assert.deepEqual(failed.map(({ key, open }) => [key, open]), [["c", true], ["c1", false], ["c2", true], ["c21", false]]);
});

test("process modules stand below the plan that runs them, and the newest plan on top", () => {
  const modules = (id) => ({ ...task(id), operator: "PROCESS-MODULES" });
  const rows = outline(treeOf(modules("early"), task("a"), modules("a's"), task("b"), task("b1", "b"), modules("b's"), task("b's1", "b's")));
  assert.deepEqual(rows.map(({ key }) => key), ["b", "b1", "b's", "b's1", "a", "a's", "early"]);
});

test("of very many plans the newest are shown, and the others counted below them", () => {
  const tasks = Array.from({ length: 100 }, (_, index) => ({ ...task(`t${index}`, "", "SUCCEEDED"), began: index, ended: index + 0.5 }));
  const rows = outline(treeOf(...tasks));
  assert.deepEqual([rows.length, rows[0].key, rows[23].key, rows.at(-1).hidden], [25, "t99", "t76", 76]);
});

test("what somebody closed stays closed", () => {
  const rows = outline(treeOf(task("a"), task("a1", "a")), new Map([["a", false]]));
  assert.deepEqual(rows.map(({ key, children, open }) => [key, children, open]), [["a", 1, false]]);
});

test("of the children of a living task that ended the newest and the failed are shown, and the others are one row", () => {
  const tasks = [task("top")];
  const states = { 3: "FAILED", 7: "RUNNING" };
  for (let index = 0; index < 1000; index++) tasks.push(task(`t${index}`, "top", states[index] ?? "SUCCEEDED"));
  const rows = outline(treeOf(...tasks));
  assert.deepEqual(rows.map(({ key, hidden, open }) => [hidden ?? key, open]), [["top", true], [997, false], ["t3", false], ["t7", false], ["t999", false]]);
  assert.equal(rows.at(-1).index, 1000);
  const wide = outline(treeOf(...tasks), new Map(), new Set(["top"]));
  assert.deepEqual([wide.length, wide[1].hidden, wide[1].open, wide[2].key], [500, 997, true, "t0"]);
});

test("a row that would stand for one task is that task", () => {
  const rows = outline(treeOf(task("top"), task("a", "top", "SUCCEEDED"), task("b", "top", "SUCCEEDED"), task("c", "top")));
  assert.deepEqual(rows.map(({ key }) => key), ["top", "a", "b", "c"]);
});

test("of very many children of a dead task the newest and the failed are shown", () => {
  const tasks = [task("top", "", "SUCCEEDED")];
  for (let index = 0; index < 1000; index++) tasks.push(task(`t${index}`, "top", index === 3 ? "FAILED" : "SUCCEEDED"));
  const rows = outline(treeOf(...tasks));
  assert.deepEqual([rows.length, rows[1].hidden, rows[2].key, rows.at(-1).key], [27, 975, "t3", "t999"]);
});

test("what runs now are living tasks without living children, but not modules that have nothing to do", () => {
  const rows = outline(treeOf(
    task("top"), task("seq", "top"), task("old", "seq", "SUCCEEDED"), task("drive", "seq"), task("held", "top", "SUSPENDED"),
    { ...task("pm"), operator: "PROCESS-MODULES" }, { ...task("idle", "pm"), waits_for: "a request to process module PEN" }, task("turn", "pm"),
  ));
  assert.deepEqual(rows.filter(({ now }) => now).map(({ key }) => key), ["drive", "turn"]);
  assert.equal(foremost(rows).key, "drive"); // the plan's before the module's
  assert.equal(foremost(rows.filter(({ root }) => root === "PROCESS-MODULES")).key, "turn");
  assert.equal(foremost(outline(treeOf(task("a", "", "SUCCEEDED")))), undefined);
});

test("the way is a dot for each tenth of a metre, and is known for any time", () => {
  const way = new Way();
  for (let tick = 0; tick <= 100; tick++) way.note(tick, [{ name: "t", x: tick * 0.051, y: 0 }, { name: "stands", x: 3, y: 3 }, { name: "nowhere", x: NaN, y: 0 }]);
  const [first, last] = way.between(-Infinity, Infinity);
  assert.ok(last - first === 52);
  assert.ok(way.dots.every(([, x, y]) => (x === 3 && y === 3) || y === 0));
  const [begin, end] = way.between(20, 40);
  assert.deepEqual([way.dots[begin][0] >= 20, way.dots[end - 1][0] <= 40, end - begin >= 9], [true, true, true]);
  const { version } = way;
  way.restart([{ message: { stamp: 5, turtles: [{ name: "t", x: 1, y: 1 }] } }]);
  assert.deepEqual([way.dots, way.version > version], [[[5, 1, 1]], true]);
});

test("of a very long way every other dot goes, again and again", () => {
  const way = new Way();
  for (let tick = 0; tick < 90_000; tick++) way.note(tick, [{ name: "t", x: (tick * 0.11) % 11, y: tick % 7 }]);
  assert.ok(way.dots.length <= 20_000 && way.dots.length > 5_000);
  assert.equal(way.dots[0][0], 0);
});

test("the name of a goal is shown without what every goal has", () => {
  assert.equal(shortName("[GOAL-PERFORM] (GOAL (PERFORM #<A MOTION (TYPE X) (OFF 1)>)), call 2"), "[PERFORM] #<A MOTION (TYPE X) (OFF 1)>, call 2");
  assert.equal(shortName("[GOAL-PERFORM] (GOAL (PERFORM #<A MOTION (TYPE MOVING) (GO..., call 3"), "[PERFORM] #<A MOTION (TYPE MOVING) (GO..., call 3");
  for (const name of ["[PAR-CHILD-#1/2]", "[GOAL-X] (GOAL (Y))", "<img>"]) assert.equal(shortName(name), name);
});

test("a task whose parent is not known stands at the top", () => {
  assert.deepEqual(outline(treeOf(task("b", "a"))).map(({ level }) => level), [1]);
});

// ------------------------------------------------------------------------------------------------------------------ series

test("a fluent keeps its value until it gets another", () => {
  const series = new Series();
  series.push(0, 0);
  series.push(WINDOW / 2, 10);
  assert.equal(series.path(WINDOW, 100, 20), "M0.0 20.0H50.0V0.0H100");
  assert.equal(series.path(WINDOW * 1.25, 100, 20), "M0.0 20.0H25.0V0.0H100");
  assert.equal(series.path(WINDOW * 3, 100, 20), "M0.0 10.0H100");
  assert.equal(new Series().path(1, 100, 20), "");
});

test("fast changes are thinned, except for the last", () => {
  const series = new Series();
  for (let index = 0; index < 10_000; index++) series.push(index * 0.016, index);
  assert.ok(series.points.length < 220, String(series.points.length));
  assert.equal(series.points.at(-1)[1], 9999);
});

test("a paper before there is one has the colour of the original's", () => {
  assert.deepEqual(new Strokes().add({ ...world(0, 0, []), r: 0, g: 0, b: 0 }).epoch.colour, [69, 86, 255]);
});

test("a recording that is put back draws its line from there", () => {
  const series = new Series();
  for (const [stamp, number] of [[0, 0], [10, 1], [20, 2], [5, 3]]) series.push(stamp, number);
  assert.deepEqual(series.points, [[0, 0], [5, 3]]);
});

test("numbers and truth are drawn, other values are not", () => {
  const values = [{ number: 2.5, value: "2.5" }, ...["T", "NIL", "#<X>"].map((value) => ({ number: null, value }))];
  assert.deepEqual(values.map(numberOf), [2.5, 1, 0, null]);
});

// ------------------------------------------------------------------------------------------------------------------ format

test("times and numbers are written for people", () => {
  assert.deepEqual([clock(0), clock(4.2), clock(187.5), clock(7387), clock(null)], ["0.00 s", "4.20 s", "3:07.5", "2:03:07", "–"]);
  assert.deepEqual([duration(0.25), duration(12.34), duration(187.5), duration(NaN)], ["0.25 s", "12.3 s", "3:07", ""]);
  assert.deepEqual([decimal(-0.001), decimal(-1.5), decimal(null), decimal(Infinity)], ["0.00", "−1.50", "NaN", "∞"]);
  assert.deepEqual([grouped(1), grouped(1200)], ["1", "1,200"]);
});

// -------------------------------------------------------------------------------------------------------------- connection

test("the token is the first message, and the subscriptions follow", () => {
  const { connection, sockets } = connected();
  connection.subscribe("/a", "std_msgs/String", () => {});
  sockets[0].onopen();
  assert.deepEqual(sockets[0].sent, [{ op: "auth", token: "t", hidden: true }, { op: "subscribe", topic: "/a", type: "std_msgs/String" }]);
});

test("a lost connection is made again, with its subscriptions, and what was asked is refused", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const { connection, sockets, states } = connected();
  const heard = [];
  connection.subscribe("/a", "std_msgs/String", (message) => heard.push(message.data));
  sockets[0].onopen();
  const call = connection.call("/reset");
  sockets[0].onclose({ code: 1006, reason: "" });
  await assert.rejects(call, { message: "/reset: the connection was lost." });
  await assert.rejects(connection.call("/clear"), { message: "/clear was not called: there is no connection." });
  assert.equal(connection.publish("/b", "x/Y", {}), false);
  t.mock.timers.tick(400);
  sockets[1].onopen();
  assert.deepEqual(states, ["connecting", "open", "lost", "connecting", "open"]);
  assert.equal(sockets[1].sent.at(-1).op, "subscribe");
  sockets[1].hear({ op: "publish", topic: "/a", msg: { data: "x" } });
  assert.deepEqual(heard, ["x"]);
});

test("it tries ever more slowly, up to a limit", (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const pauses = [];
  const { sockets } = connected({ changed: (state, pause) => state === "lost" && pauses.push(pause) });
  for (let index = 0; index < 10; index++) {
    sockets.at(-1).onclose({ code: 1006 });
    t.mock.timers.tick(5000);
  }
  assert.deepEqual(pauses.slice(0, 2), [400, 640]);
  assert.equal(pauses.at(-1), 5000);
});

test("a session that refuses the token is not asked again, one that throws out a slow reader is", (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const refused = connected();
  refused.sockets[0].onopen();
  refused.sockets[0].onclose({ code: 1008, reason: "no" });
  t.mock.timers.tick(60_000);
  assert.deepEqual([refused.states.at(-1), refused.sockets.length], ["refused", 1]);
  const slow = connected();
  slow.sockets[0].onopen();
  slow.sockets[0].hear({ op: "status", level: "error", msg: "slow" });
  slow.sockets[0].onclose({ code: 1008, reason: "slow" });
  t.mock.timers.tick(60_000);
  assert.equal(slow.sockets.length, 2);
});

test("answers find their questions; refusals carry the session's text; broken JSON is overheard", async () => {
  const { connection, sockets } = connected();
  sockets[0].onopen();
  const [one, other] = [connection.call("/a"), connection.call("/b")];
  const [first, second] = sockets[0].sent.filter(({ op }) => op === "call_service");
  sockets[0].onmessage({ data: "{" });
  sockets[0].hear({ op: "service_response", id: second.id, values: "not so", result: false });
  sockets[0].hear({ op: "service_response", id: first.id, values: { x: 1 }, result: true });
  sockets[0].hear({ op: "service_response", id: "another", values: {}, result: true });
  assert.deepEqual(await one, { x: 1 });
  await assert.rejects(other, { message: "not so" });
});

test("a server that says nothing is asked, and given up for a new connection when it does not answer", (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const { sockets, states } = connected();
  sockets[0].onopen();
  t.mock.timers.tick(2999);
  assert.ok(!sockets[0].sent.some(({ op }) => op === "ping"));
  t.mock.timers.tick(1);
  assert.equal(sockets[0].sent.at(-1).op, "ping");
  t.mock.timers.tick(2000);
  sockets[0].hear({ op: "pong" });
  for (const passed of [3000, 2999]) t.mock.timers.tick(passed);
  assert.deepEqual([states.at(-1), sockets.length], ["open", 1]);
  t.mock.timers.tick(1);
  assert.deepEqual([states.at(-1), sockets[0].closed], ["lost", true]);
  t.mock.timers.tick(400);
  assert.deepEqual([states.at(-1), sockets.length], ["connecting", 2]);
  for (const passed of [3000, 3000]) t.mock.timers.tick(passed); // this one is not even accepted
  assert.deepEqual([states.at(-1), sockets[1].closed], ["lost", true]);
});

test("the token is in the address; after an attempt that failed it goes out with the first message alone, which is told why", (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const addresses = [];
  const sockets = [];
  const connection = new Connection({ url: "ws://x/", token: "a b", make: (address) => {
    addresses.push(address);
    sockets.push(new FakeSocket());
    return sockets.at(-1);
  } });
  connection.connect();
  sockets[0].onclose({ code: 1006, reason: "" });
  t.mock.timers.tick(1000);
  sockets[1].onopen();
  sockets[1].hear({ op: "pong" });
  assert.deepEqual(sockets[1].sent[0], { op: "auth", token: "a b", hidden: true });
  sockets[1].onclose({ code: 1006, reason: "" });
  t.mock.timers.tick(1000);
  sockets[2].onclose({ code: 1006, reason: "" });
  t.mock.timers.tick(1000);
  const shown = "ws://x/?token=a%20b&hidden=1";
  assert.deepEqual(addresses, [shown, "ws://x/", "ws://x/", shown]);
});

test("who does not answer is not waited for", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const { connection, sockets } = connected();
  sockets[0].onopen();
  const call = connection.call("/a");
  for (let second = 0; second < 10; second++) {
    sockets[0].hear({ op: "pong" });
    t.mock.timers.tick(1000);
  }
  await assert.rejects(call, { message: "/a has not answered for 10 seconds." });
});

// ----------------------------------------------------------------------------------------------------------------- session

const STATE = (stamp, strokes = []) => ({
  world: world(stamp, 1, strokes),
  tasks: { stamp, tasks: [task("a")], removed: [] },
  fluents: { stamp, fluents: [], removed: [] },
  modules: { stamp, modules: [] },
  robots: { stamp, things: [], removed: [], steps: [], marks: [] },
  pace: { stamp, virtual: true, paused: false, speed: 1, busy: false, recording: "", begin: 0, end: 0 },
});

async function visiting(t, told) {
  t.mock.timers.enable({ apis: ["setTimeout"] }); // else node would wait for the answers that never come
  const sockets = [];
  const seen = { anew: 0, older: 0, heard: [], failed: [] };
  const session = new Session({
    url: "ws://x", token: "t", now: () => 0, rosout: () => {}, connection: () => {},
    heard: (kind, message, sample) => seen.heard.push([kind, sample?.strokes]), anew: () => seen.anew++, older: () => seen.older++,
    failed: (error) => seen.failed.push(error.message),
    make: () => {
      sockets.push(new FakeSocket());
      return sockets.at(-1);
    },
  });
  session.connect();
  const answer = async (service, values, result = true) => {
    const { id } = sockets.at(-1).sent.findLast((message) => message.service === service);
    sockets.at(-1).hear({ op: "service_response", id, values, result });
    await new Promise(setImmediate);
  };
  sockets[0].onopen();
  await answer("/cramhy/get_state", told);
  return { session, sockets, seen, answer };
}

test("what comes before the answer to get_state is in that answer", async (t) => {
  const { session, sockets, seen, answer } = await visiting(t, STATE(5));
  sockets[0].onclose({ code: 1006 });
  session.connect();
  sockets[1].onopen();
  const count = seen.heard.length;
  sockets[1].hear({ op: "publish", topic: "/cramhy/tasks", msg: { stamp: 6, tasks: [task("b")], removed: [] } });
  assert.equal(seen.heard.length, count);
  await answer("/cramhy/get_state", STATE(7));
  assert.deepEqual([...session.live.tasks.keys()], ["a"]);
  assert.equal(seen.anew, 1);
  assert.equal(session.history.start, 5);
});

test("a session whose time lies before what was known is another one", async (t) => {
  const { session, sockets, seen, answer } = await visiting(t, STATE(50));
  sockets[0].onclose({ code: 1006 });
  session.connect();
  sockets[1].onopen();
  await answer("/cramhy/get_state", STATE(3));
  assert.equal(seen.anew, 2);
  assert.equal(session.history.end, 3);
});

test("chapters of the past are fetched one by one", async (t) => {
  const { session, sockets, seen, answer } = await visiting(t, STATE(20, [line(1), line(2), line(3)]));
  const chapter = (number, begin, end, strokes, later) => ({
    chapter: number, oldest: 1, newest: 2, begin, end, ...STATE(begin, strokes), later_world: later,
    later_tasks: [{ stamp: end, tasks: [task(`t${number}`)], removed: [] }], later_fluents: [], later_modules: [], later_robots: [],
  });
  await answer("/cramhy/get_history", chapter(2, 10, 19, [line(1)], [world(12, 1, [line(2)]), world(19, 1, [line(3)])]));
  sockets[0].hear({ op: "publish", topic: "/cramhy/world", msg: world(21, 1, [line(4)]) });
  assert.equal(session.start, 10);
  assert.ok(session.more);
  session.earlier();
  await answer("/cramhy/get_history", chapter(1, 1, 9, [], [world(9, 1, [line(1)])]));
  assert.equal(session.more, false);
  assert.equal(session.start, 1);
  const drawn = (stamp) => session.strokes.at(stamp).strokes - session.strokes.at(stamp).epoch.start;
  assert.deepEqual([1, 9, 10, 12, 19, 20, 21].map(drawn), [0, 1, 1, 2, 3, 3, 4]);
  assert.deepEqual([...session.history.at(9.5).tasks.keys()], ["a", "t1"]);
  assert.deepEqual([session.worldAt(12).turtles[0].x, session.history.at(21).world.turtles[0].x], [12, 21]);
  assert.deepEqual([seen.older, seen.failed], [2, []]);
});

test("of the times of a recording that are wanted meanwhile the last one is sought", async (t) => {
  const { session, sockets, answer } = await visiting(t, STATE(5));
  let done = false;
  session.seek(1).then(() => (done = true));
  for (const stamp of [2, 3, 4]) session.seek(stamp);
  const sought = () => sockets[0].sent.filter(({ service }) => service === "/cramhy/seek").map(({ args }) => args.stamp);
  assert.deepEqual(sought(), [1]);
  await answer("/cramhy/seek", {});
  assert.deepEqual([sought(), done], [[1, 4], false]);
  await answer("/cramhy/seek", {});
  assert.deepEqual([sought(), done], [[1, 4], true]);
  await assert.rejects((session.seek(9), answer("/cramhy/seek", "no", false), session.seeking), { message: "no" });
  session.seek(6).catch(() => {});
  assert.deepEqual(sought(), [1, 4, 9, 6]);
});

test("a pose that is no number is one again: JSON has none", async (t) => {
  const { session } = await visiting(t, { ...STATE(5), world: world(5, 1, [], { turtles: [turtle(null, { theta: 0 })] }) });
  const [{ x, y, theta }] = session.live.world.turtles;
  assert.deepEqual([x, y, theta], [NaN, 1, 0]);
});

test("when the state cannot be had, that is said, and it is asked for again", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const sockets = [];
  const failed = [];
  const nothing = { rosout: () => {}, connection: () => {}, heard: () => {}, anew: () => {}, older: () => {} };
  const make = () => {
    sockets.push(new FakeSocket());
    return sockets.at(-1);
  };
  const session = new Session({ url: "ws://x", token: "t", now: () => 0, ...nothing, failed: (error) => failed.push(error.message), make });
  session.connect();
  sockets[0].onopen();
  const calls = () => sockets[0].sent.filter(({ service }) => service === "/cramhy/get_state");
  sockets[0].hear({ op: "service_response", id: calls()[0].id, values: "There is no service /cramhy/get_state.", result: false });
  await new Promise(setImmediate);
  assert.deepEqual(failed, ["There is no service /cramhy/get_state."]);
  t.mock.timers.tick(1500);
  assert.equal(calls().length, 2);
});
