// Which rows the task tree shows, in which order. The newest plan is on top, with the process modules that it started, so that it is in
// sight however many have run; each task stands below its parent. A task that lives is open, one that is dead is closed unless it
// belongs to the last plan, and what somebody opened or closed stays so. Of very many children the newest are shown, and those that
// live or failed.

const ALIVE = new Set(["CREATED", "RUNNING", "WAITING", "SUSPENDED"]);
const NEWEST = 24;
const MOST_ROWS = 500;
const MODULES = "PROCESS-MODULES";

export const alive = (task) => ALIVE.has(task.state);

// tasks: Map id → Task. choices: Map id → whether somebody opened it. wide: ids of which all children are wanted.
// Rows are {key, task, level, index, of, children, open} or {key, parent, level, hidden: number}.
export function outline(tasks, choices = new Map(), wide = new Set()) {
  const children = new Map();
  const roots = [];
  for (const task of tasks.values()) {
    if (!task.parent || !tasks.has(task.parent)) roots.push(task);
    else if (children.has(task.parent)) children.get(task.parent).push(task);
    else children.set(task.parent, [task]);
  }
  const rows = [];
  const last = roots.at(-1);
  const recent = new Set(roots.filter(({ ended }) => ended === null || ended >= last.began)); // the last plan, and what ran beside it

  function list(siblings, level, parent, opened) {
    const newestFirst = level === 1;
    const shown = selection(siblings, wide.has(parent), newestFirst);
    const rest = shown.length < siblings.length ? [{ key: `more ${parent}`, parent, level, hidden: siblings.length - shown.length }] : [];
    if (!newestFirst) rows.push(...rest);
    for (const [task, index] of shown) {
      if (rows.length >= MOST_ROWS) return;
      const below = children.get(task.id) ?? [];
      const open = below.length > 0 && (choices.get(task.id) ?? (alive(task) || opened || recent.has(task)));
      rows.push({ key: task.id, task, level, index: index + 1, of: siblings.length, children: below.length, open });
      if (open) list(below, level + 1, task.id, opened || recent.has(task));
    }
    if (newestFirst) rows.push(...rest);
  }

  list(newestPlanFirst(roots), 1, "", false);
  return rows;
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

// [task, index] of those that are shown.
function selection(siblings, all, newestFirst) {
  const numbered = siblings.map((task, index) => [task, index]);
  if (all || siblings.length <= NEWEST * 2) return numbered;
  const begin = siblings.length - NEWEST;
  const isNew = newestFirst ? (index) => index < NEWEST : (index) => index >= begin;
  return numbered.filter(([task, index]) => isNew(index) || alive(task) || task.state === "FAILED");
}
