// Which rows the task tree shows, in which order. Plans stand one below the other, each task below its parent; a task that lives is
// open, one that is dead is closed unless it belongs to the last plan, and what somebody opened or closed stays so. Of very many
// children the newest are shown, and those that live or failed.

const ALIVE = new Set(["CREATED", "RUNNING", "WAITING", "SUSPENDED"]);
const NEWEST = 24;
const MOST_ROWS = 500;

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
    const shown = selection(siblings, wide.has(parent));
    if (shown.length < siblings.length) rows.push({ key: `more ${parent}`, parent, level, hidden: siblings.length - shown.length });
    for (const [task, index] of shown) {
      if (rows.length >= MOST_ROWS) return;
      const below = children.get(task.id) ?? [];
      const open = below.length > 0 && (choices.get(task.id) ?? (alive(task) || opened || recent.has(task)));
      rows.push({ key: task.id, task, level, index: index + 1, of: siblings.length, children: below.length, open });
      if (open) list(below, level + 1, task.id, opened || recent.has(task));
    }
  }

  list(roots, 1, "", false);
  return rows;
}

// [task, index] of those that are shown.
function selection(siblings, all) {
  const numbered = siblings.map((task, index) => [task, index]);
  if (all || siblings.length <= NEWEST * 2) return numbered;
  const begin = siblings.length - NEWEST;
  return numbered.filter(([task, index]) => index >= begin || alive(task) || task.state === "FAILED");
}
