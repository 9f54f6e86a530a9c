// The page: it puts the session and the views together, and gives each its turn. The world is drawn in every frame in which it moves;
// of the panels at most one, so that none of them costs the turtle a frame. What goes wrong is said at the foot of the page.

import { STATES } from "./connection.js";
import { byId, setText } from "./dom.js";
import { Drive } from "./drive.js";
import { FluentsView } from "./fluents.js";
import { clock } from "./format.js";
import { LogView } from "./log.js";
import { ModulesView } from "./modules.js";
import { PaceView } from "./pace.js";
import { offerPanes } from "./panes.js";
import { Pictures } from "./paper.js";
import { Session } from "./session.js";
import { offerSwitch } from "./settings.js";
import { Stage } from "./stage.js";
import { StatusView } from "./status.js";
import { t, translate } from "./texts.js";
import { offerThemes } from "./theme.js";
import { Timeline } from "./timeline.js";
import { make, ready, token, url } from "./transport.js";
import { TreeView } from "./tree.js";
import { WorldView } from "./world.js";

const PANEL_PAUSE = 100; // ms between two looks at a panel
const STANDS = t("Virtual time stands still while the prompt waits. Step lets some of it pass.");
const PAGE = /^http:\/\/127\.0\.0\.1:\d+\/#[\w-]+$/; // the address of a session's page
const IS_PAST = t("This is a recording: what its turtles did is done, and they cannot be driven.");

// In a few words, what goes on; running: the task that runs now, or "".
function doing({ recording, paused, busy }, running) {
  if (recording) return t("replays {recording}", { recording });
  const what = paused ? t("paused") : busy ? t("a form runs") : t("the prompt waits");
  return running ? `${what}: ${running}` : what;
}

// The turtle lives in another session from now on; data: the address of its page.
function moved({ data }) {
  if (PAGE.test(data)) location.replace(data);
}

async function start() {
  translate(document.body);
  offerThemes(byId("theme"), byId("projector"));
  offerPanes(document.querySelector("main"), byId("tabs"));
  const shapes = await fetch("shapes.json");
  if (!shapes.ok) throw new Error(`the server has no shapes.json (${shapes.status})`);
  const pictures = new Pictures(await shapes.json());
  const past = { stamp: null, state: null }; // the moment of the past that is shown
  const status = new StatusView({ pill: byId("connection"), banner: byId("banner"), notice: byId("notice") });
  const failed = (error) => status.failed(error);
  const session = new Session({
    url, token, make, heard, anew, older, rosout, moved, failed,
    connection: (...news) => status.connection(...news),
  });
  const world = new WorldView({
    canvas: byId("paper"), empty: byId("empty"), turtles: byId("turtles"), pose: byId("pose"), where: byId("where"),
    strokes: session.strokes, pictures,
  });
  const tree = new TreeView({ tree: byId("tasks"), none: byId("no-tasks"), count: byId("tasks-count"), follow: byId("follow") });
  const fluents = new FluentsView({ list: byId("fluents"), count: byId("fluents-count") });
  const modules = new ModulesView({ list: byId("modules") });
  const log = new LogView({ scroller: byId("log"), list: byId("log").firstElementChild, level: byId("level") });
  const call = (service, args) => session.bridge.call(service, args);
  const stage = new Stage({
    stage: byId("easel"), controls: byId("controls"), worlds: byId("worlds"), title: byId("stage-title"), tab: byId("turtle-tab"),
    live: () => session.live, failed, say: (...text) => status.say(...text),
    move: (name, [x, y, z]) => call("/cramhy/move_thing", { name, x, y, z }),
  });
  const pace = new PaceView({ pause: byId("pause"), step: byId("step"), size: byId("step-size"), speed: byId("speed"), call, failed });
  const timeline = new Timeline({ slider: byId("moment"), strip: byId("strip"), button: byId("live"), seek, live });
  const wheel = new Drive({ pad: byId("pad"), publish: drive, call, turtle: () => (stage.showsRoom ? null : world.chosen) });
  for (const name of ["clear", "reset"]) byId(name).addEventListener("click", () => call(wheel.namespace + name).catch(failed));
  byId("earlier").addEventListener("click", () => session.earlier());
  for (const what of ["grid", "goals", "way"]) offerSwitch(byId(`show-${what}`), `show-${what}`, (on) => world.show(what, on));
  offerSwitch(byId("fluents-all"), "fluents-all", (on) => (fluents.all = on));
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && !event.defaultPrevented && !status.hush() && past.stamp !== null) timeline.present();
  });

  const shown = () => past.state ?? session.live;
  const moment = () => past.stamp ?? session.time;
  const panels = [
    () => {
      world.read(shown().modules);
      stage.read();
    },
    () => tree.render(shown(), moment()),
    () => fluents.render(shown(), moment(), past.state && session.history),
    () => modules.render(shown()),
    () => log.render(past.stamp ?? Infinity),
    () => {
      pace.render(session.bridge.open ? session.live.pace : null);
      setText(byId("clock"), clock(moment()));
      setText(byId("doing"), session.joined ? doing(session.live.pace, past.state ? "" : tree.running) : "");
      document.body.classList.toggle("replaying", Boolean(session.live.pace?.recording));
    },
    () => {
      const { recording, begin, end } = session.live.pace ?? {};
      const now = session.time;
      const known = recording ? { start: begin, end } : { start: session.start, end: now };
      timeline.render({ tasks: session.live.tasks, now, recording, ...known });
      byId("earlier").hidden = !session.more;
    },
  ].map((render) => ({ render, last: -Infinity }));

  function heard(kind, message, sample) {
    if (sample) {
      world.tick(sample, performance.now());
      if (message.simulator !== wheel.simulator) wheel.enter(message.simulator);
    } else if (kind === "robots") stage.hear(message);
    else if (kind === "fluents") fluents.note(message);
    else if (kind === "tasks" && message.complete && session.live.pace?.recording) { // somebody sought
      log.forget();
      world.way.forget();
    } else if (kind === "pace") world.playback.rate = message.virtual ? message.speed : 1;
  }

  function anew() {
    world.forget();
    fluents.forget();
    tree.forget();
    wheel.forget();
    timeline.present();
  }

  function older() {
    world.paper.forget();
    world.way.restart(session.history.between("world", -Infinity, Infinity));
    if (past.stamp !== null) seek(past.stamp);
  }

  function drive(...message) {
    const { virtual, busy, recording } = session.live.pace ?? {};
    if (recording) status.say(IS_PAST);
    else if (session.bridge.publish(...message) && virtual && !busy) status.say(STANDS);
  }

  function rosout(message) {
    log.add(message, session.live.stamp);
  }

  function seek(stamp) {
    if (session.live.pace?.recording) {
      session.seek(stamp).catch(failed).finally(() => (timeline.past = null));
      return;
    }
    past.stamp = stamp;
    past.state = session.history.at(stamp);
    world.showPast(session.worldAt(stamp, past.state));
    byId("past").hidden = false;
    const said = t("as it was at {time}", { time: clock(stamp) });
    setText(byId("past"), said);
    stage.showPast(past.state.robots, said);
    document.body.classList.add("looking-back");
    hurry();
    if (stamp <= session.start + 0.02 * (session.time - session.start)) session.earlier();
  }

  function live() {
    past.stamp = past.state = null;
    world.showPast(null);
    stage.showPast(null);
    byId("past").hidden = true;
    document.body.classList.remove("looking-back");
    hurry();
  }

  // All panels at their next turn, though they have just been drawn.
  function hurry() {
    for (const panel of panels) panel.last = -Infinity;
  }

  function frame(now) {
    requestAnimationFrame(frame);
    if (stage.showsRoom) stage.frame(now);
    else world.frame(now);
    let waiting = null;
    for (const panel of panels) if (now - panel.last >= PANEL_PAUSE && (!waiting || panel.last < waiting.last)) waiting = panel;
    if (!waiting) return;
    waiting.last = now;
    waiting.render();
  }

  if (token) ready.then(() => session.connect());
  else status.connection(STATES.REFUSED, t("this address has no token"));
  requestAnimationFrame(frame);
}

start().catch((error) => {
  setText(byId("banner"), t("The page could not start: {why}. Load it again; if that does not help, start the session anew.", { why: error.message }));
  byId("banner").hidden = false;
});
