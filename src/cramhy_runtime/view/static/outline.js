// Which rows the task tree shows, in which order. The newest plan is on top, with the process modules that it started, so that it is in
// sight however many have run; each task stands below its parent. A task that lives is open. Of its children that ended, the newest and
// those that failed stay; the others are folded into one row. A task that ended is closed, but for the last plan, which is open down to
// what failed. What somebody opened or closed stays so. Of very many children of an ended task the newest are shown.

const ALIVE = new Set(["CREATED", "RUNNING", "WAITING", "SUSPENDED"]);
const NEWEST = 24;
const LEAST_FOLDED = 2; // a row that stands for one row saves nothing
const MOST_ROWS = 500;
const MODULES = "PROCESS-MODULES";
const IDLE = "a request to "; // what a process module waits for that has nothing to do

export const alive = (task) => ALIVE.has(task.state);

// tasks: Map id → Task. choices: Map id → whether somebody opened it. wide: ids of which all children are wanted.
// Rows are {key, task, level, index, of, children, open, now, root}, or {key, parent, level, index, of, hidden: number, open} for children
// that are folded. now: whether this is what runs now, a task without children that does something. root: the operator of its plan.
export function outline(tasks, choices = new Map(), wide = new Set()) {
  const children = new Map();
  const roots = [];
  const busy = new Set(); // ids of tasks with children that live
  const failing = new Set(); // ids of tasks below which something failed
  for (const task of tasks.values()) {
    if (!task.parent || !tasks.has(task.parent)) roots.push(task);
    else if (children.has(task.parent)) children.get(task.parent).push(task);
    else children.set(task.parent, [task]);
    if (alive(task)) busy.add(task.parent);
    if (task.state === "FAILED") for (let id = task.parent; id && !failing.has(id); id = tasks.get(id)?.parent) failing.add(id);
  }
  const rows = [];
  const last = roots.at(-1);
  const recent = new Set(roots.filter(({ ended }) => ended === null || ended >= last.began)); // the last plan, and what ran beside it
  const isNow = (task) => (task.state === "RUNNING" || task.state === "WAITING") && !busy.has(task.id) && !task.waits_for.startsWith(IDLE);

  // siblings: the tasks to list. parent: their id. folds: whether it lives. opened: whether it belongs to the last plan. root: of all of them.
  function list(siblings, level, parent, { folds, opened, root }) {
    const top = level === 1;
    const [shown, hidden] = selection(siblings, folds, top);
    const all = hidden > 0 && wide.has(parent);
    const fold = { key: `more ${parent}`, parent, level, index: top ? siblings.length : 1, of: siblings.length, hidden, open: all };
    if (hidden && !top) rows.push(fold);
    for (const [task, index] of all ? numbered(siblings) : shown) {
      if (rows.length >= MOST_ROWS) return;
      const below = children.get(task.id) ?? [];
      const inLast = opened || recent.has(task);
      const usual = alive(task) || (top && inLast) || (opened && failing.has(task.id));
      const open = below.length > 0 && (choices.get(task.id) ?? usual);
      const operator = root ?? task.operator;
      rows.push({ key: task.id, task, level, index: index + 1, of: siblings.length, children: below.length, open, now: isNow(task), root: operator });
      if (open) list(below, level + 1, task.id, { folds: alive(task), opened: inLast && !alive(task), root: operator });
    }
    if (hidden && top) rows.push(fold);
  }

  list(newestPlanFirst(roots), 1, "", { folds: false, opened: false });
  return rows;
}

// The row that is to be in sight: the newest task that runs now, of a plan rather than of a process module. Undefined when nothing runs.
export function foremost(rows) {
  return rows.findLast(({ now, root }) => now && root !== MODULES) ?? rows.findLast(({ now }) => now);
}

// Process modules are no part of the plan that runs them, but begin after it and stand below it.
function newestPlanFirst(roots) {
  const plans = [];
  for (const root of roots) {
    if (root.operator === MODULES && plans.length) plans.at(-1).push(root);
    else plans.push([root]);
  }
  return plans.reverse().flat();
}

const numbered = (siblings) => siblings.map((task, index) => [task, index]);

// [task, index] of those that are shown, and how many are not.
function selection(siblings, folds, newestFirst) {
  const count = siblings.length;
  let isNew = (index) => index >= count - NEWEST;
  if (folds) {
    const newest = siblings.findLastIndex((task) => !alive(task));
    isNew = (index) => index === newest;
  } else if (count <= NEWEST * 2) return [numbered(siblings), 0];
  else if (newestFirst) isNew = (index) => index < NEWEST;
  const shown = numbered(siblings).filter(([task, index]) => isNew(index) || alive(task) || task.state === "FAILED");
  return count - shown.length < LEAST_FOLDED ? [numbered(siblings), 0] : [shown, count - shown.length];
}
