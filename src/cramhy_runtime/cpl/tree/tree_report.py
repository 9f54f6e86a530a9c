"""``describe-task-tree``: the tasks of a plan as a tree of text, while it runs and after its end.

A plan is a tree of tasks. The tree shows why a plan does not do what it should: which branches live, what each waits for and where in
the text, and the results of those that are dead. CRAM has logs for this; py_trees prints its tree, and its users rely on that. The
report reads what the tasks know anyway. It consumes no pulse and wakes no task, and it does not number the names of tasks.

Parents forget their dead children. So the report shows the dead tasks that a node of the task tree holds (plan functions, goals, tags),
with the tasks above them. For plans that began while ``*record-task-tree*`` was true it shows all. When Ctrl-C, a deadlock or the time
limit ends a plan, its state is noted down for the report.
"""

from __future__ import annotations

from io import StringIO

from cramhy_runtime.kernel.images import Cell
from cramhy_runtime import kernel

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import NO_VALUES, Cons, Keyword, Symbol, all_values, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.packages import CURRENT as PACKAGE
from cramhy_runtime.lisp_core.packages import sym as lisp_symbol
from cramhy_runtime.lisp_core.printing import attempt_to_print, prin1_to_string
from cramhy_runtime.lisp_core.output import designated_stream
from cramhy_runtime.lisp_core.printing import report_text
from ..tasks.branches import Branches
from ..current import current_task
from ..failures.failure_types import opened
from ..statuses import ALIVE, CREATED, EVAPORATED, FAILED, RUNNING, SUCCEEDED, SUSPENDED
from ..symbols import CPL_IMPL
from ..tasks.tasks import RECORD, AbstractTask, recorded
from .task_tree import CALL, TaskTreeNode, flatten_task_tree, named_tree
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..signatures import PlanTree

LONGEST = 60
"""The report shows so many characters of a value, a failure or a reason."""

BOX = {"more": "├─ ", "last": "└─ ", "line": "│  ", "none": "   "}
ASCII = {"more": "|- ", "last": "`- ", "line": "|  ", "none": "   "}
STYLES = {SUCCEEDED: "green", FAILED: "bold red", EVAPORATED: "dim", SUSPENDED: "yellow", RUNNING: "cyan", CREATED: "dim"}

_stopped = Cell(None, fresh=True)  # (heading, lines, kernel) of the last plan that the user or the kernel ended

PRINT_LENGTH, PRINT_LEVEL, PRINT_PRETTY = map(lisp_symbol, ("*PRINT-LENGTH*", "*PRINT-LEVEL*", "*PRINT-PRETTY*"))


def describe_task_tree(of: PlanTree | None = None, *, stream: object = None, depth: int | None = None, dead: bool | None = True) -> None:
    """``(describe-task-tree)``: print the tree of the tasks that live now. When no plan runs, print the last one interrupted or recorded.

    of: a task, a task tree or the name of a top-level, to print only that. depth: the number of levels below the first; ``None`` is all.
    dead: nil leaves out dead tasks. stream: as in ``describe``; on a terminal, with the package rich, the statuses are coloured.
    A ``depth`` that is not a number from 0 on, or an ``of`` that has no tree, is an error.
    """
    if depth is not None and not (isinstance(depth, int) and depth >= 0):
        error("The depth of a report is a number of levels, 0 or more, not ~S.", depth)
    heading, lines = _report(of, depth, dead is not None and dead is not False)
    out = designated_stream(stream)
    out.fresh_line()
    out.write((heading + "\n" if heading else "") + shown(lines, _file_of(out)))
    return NO_VALUES  # type: ignore[return-value]  # for Lisp, which prints none


def describe_task_tree_in_lisp(*arguments):
    """``(describe-task-tree &optional of &key stream depth dead)``. Options may also come first, since keywords do not name trees."""
    return _lisp(*((None, *arguments) if arguments and isinstance(arguments[0], Keyword) else arguments))


_lisp = lispify(describe_task_tree)


def task_tree_text(of: PlanTree | None = None, *, depth: int | None = None, dead: bool | None = True) -> str:
    """The text that `describe_task_tree` prints, as a string."""
    out = StringIO()
    describe_task_tree(of, stream=out, depth=depth, dead=dead)
    return out.getvalue()


def note_stopped(task, exception):
    """Note down the state of the plan of the top-level ``task``, because ``exception`` is about to end it."""
    what = {kernel.Deadlock: "when nothing could happen any more", kernel.TimeLimit: "when its time was over"}
    heading = f"No plan runs now. The last one {what.get(type(exception), 'when it was interrupted')}, at {_seconds(kernel.now())}:"
    _stopped.value = heading, Forest([task]).lines(None, True), kernel.active()


# ------------------------------------------------------------------------------------------------------------- which tasks


def _report(of, depth, dead):
    """(heading or ``None``, lines) of a report."""
    if of is None:
        living = living_plans()
        if living:
            return None, Forest(living).lines(depth, dead)
        here = kernel.active()
        if _stopped.value is not None and _stopped.value[2] is here:
            return _stopped.value[0], [line for line in _stopped.value[1] if depth is None or line.level <= depth]
        mine = [task for task in recorded if task.kernel_task.kernel is here]
        if mine:
            return "No plan runs now. The last one that was recorded:", Forest(mine[-1:]).lines(depth, dead)
        return f"No plan runs now. Plans that begin while {RECORD.name.lower()} is true are kept for this report.", []
    if isinstance(of, AbstractTask):
        return None, Forest([of]).lines(depth, dead)
    tree = of if isinstance(of, TaskTreeNode) else named_tree(of) if isinstance(of, Symbol) else None
    if tree is None:
        error(
            "There is no task tree of ~S. What is described is a task, a task tree, or the name of a top-level that has run; nil is "
            "for all that runs now.",
            of,
        )
    roots = plans_of(tree)
    return (None, Forest(roots).lines(depth, dead)) if roots else (f"Nothing of {prin1_to_string(of)} has run.", [])


def living_plans():
    """The tasks of all ``top-level`` forms that run now, the oldest first."""
    tasks = [task.owner for task in kernel.active().tasks]
    return [task for task in tasks if task is not None and task.parent is None]


def plans_of(tree):
    """The ``top-level`` tasks to which ``tree``, a task tree or a part of one, belongs: living ones, or else recorded ones, or else those
    that its nodes hold."""
    roots = [task for task in living_plans() if task.tree is tree] or [task for task in recorded if task.tree is tree][-1:]
    return roots or list(dict.fromkeys(_root(task) for task in node_tasks(tree)))


def node_tasks(tree):
    """The executed tasks that the nodes of ``tree`` hold."""
    tasks = [code.task for code in (node.effective_code for node in flatten_task_tree(tree)) if code is not None and code.task is not None]
    return [task for task in tasks if task.kernel_task is not None]


def _root(task):
    while task.parent is not None:
        task = task.parent
    return task


class Forest:
    """The trees below the tasks ``roots``, with the dead tasks that are still known."""

    def __init__(self, roots):
        self.roots = roots
        self.children = {}
        for root in roots:
            for task in root.record or ():
                self.add(task)
            living = [root]
            for task in living:
                self.add(task)
                living += task.children
            for task in node_tasks(root.tree) if root.tree is not None else ():
                self.add(task)

    def add(self, task):
        """Note that ``task`` is a child of its parent, and so on up."""
        while task.parent is not None:
            siblings = self.children.setdefault(task.parent, {})
            if task in siblings:
                return
            siblings[task] = True
            task = task.parent

    def below(self, task, dead):
        """The children of ``task`` in the order in which they started, then the living threads that it spawned."""
        if isinstance(task, kernel.Task):
            return []
        known = [child for child in self.children.get(task, ()) if dead or child.alive]
        known.sort(key=lambda child: child.kernel_task.id if child.kernel_task is not None else 0)
        return known + [thread for thread in task.threads if not thread.dead]

    def lines(self, depth, dead):
        """The lines of the report, a `Line` for each task, parents before children."""
        found, waiting = [], [(root, (), 0) for root in reversed(self.roots)]
        while waiting:
            task, lead, level = waiting.pop()
            below = self.below(task, dead)
            hidden = depth is not None and level == depth and self.count(below, dead)
            found.append(Line(lead, level, *described(task, f"{hidden} more below" if hidden else "")))
            if not hidden:
                inner = (*lead[:-1], {"more": "line", "last": "none"}[lead[-1]]) if lead else ()
                waiting += [(child, (*inner, "more" if number else "last"), level + 1) for number, child in enumerate(reversed(below))]
        return found

    def count(self, tasks, dead):
        """The number of ``tasks`` and of all tasks below them."""
        waiting, number = list(tasks), 0
        while waiting:
            number += 1
            waiting += self.below(waiting.pop(), dead)
        return number


# ------------------------------------------------------------------------------------------------------ what is said of each


class Line:
    """One task in the report: the strokes that ``lead`` to it, its ``name`` and place, its ``status``, and the ``rest`` of the text."""

    __slots__ = ("lead", "level", "name", "status", "rest")

    def __init__(self, lead, level, name, status, rest):
        self.lead, self.level, self.name, self.status, self.rest = lead, level, name, status, rest

    @property
    def alive(self):
        """Whether the task is alive."""
        return self.status in ALIVE


def described(task, more=""):
    """(name and place, status, the rest) of ``task``, which may also be a thread of one, a task of the kernel."""
    if isinstance(task, kernel.Task):
        text = "running, is being killed" if task.cancelled else "running"
        return f"thread {task.name}", RUNNING, ", ".join(text for text in (_waiting(task, text), more) if text)
    name = title(task)
    rest = [_outcome(task) if task.dead else _doing(task), more]
    return name, task.status, ", ".join(text for text in rest if text)


def title(task):
    """The name of ``task``, and the part of the path that it adds to its parent's."""
    if task.path is not None and (task.parent is None or task.parent.path is not task.path):
        return f"{task.plain_name} {_part(task)}"
    return task.plain_name


def _part(task):
    """The part of the path that the task adds to its parent's; for a plan function and a goal with the arguments of the call."""
    part = list(task.path.car) if isinstance(task.path.car, Cons) else [task.path.car]
    times = f", call {part.pop()}" if len(part) > 2 and part[-2] is CALL else ""
    if times:
        part.pop()
    parameters = task.code.parameters if task.code is not None and len(part) == 1 else None
    home = next((symbol.package for symbol in _symbols(part) if symbol.package not in (CPL_IMPL, None)), PACKAGE.value)
    if task.code is not None and task.code.called_with is not None:
        part[1] = Cons(part[1].car, task.code.called_with)
    with binding(PACKAGE, home):
        return short(list_from([*part, *(parameters or ())])) + times


def _symbols(form):
    """The symbols in a path part, from left to right."""
    for element in form:
        if isinstance(element, Symbol):
            yield element
        elif isinstance(element, Cons):
            yield from _symbols([element.car, element.cdr])


def _outcome(task):
    """A text about the end of a dead task."""
    took = f" after {_seconds(task.ended_at - task.started_at)}" if task.started_at is not None else ""
    if task.status is SUCCEEDED:
        values = all_values(task.result)
        return f"succeeded{took}: {', '.join(map(short, values)) or 'no values'}"
    if task.status is FAILED:
        text, position = failure(task)
        return f"failed{took}: {text} at {position}" if position else f"failed{took}: {text}"
    return "evaporated" + (took or " before it began")


def failure(task):
    """(the failure of a dead task as text, the place where it arose or "")."""
    condition = opened(task.result)
    return _failure(condition), describe(getattr(condition, "position", None)) or ""


def _failure(condition):
    if not isinstance(condition, types.Condition):
        return cut(repr(condition))
    name = symbol_name(class_name(type(condition)))
    try:
        text = cut(report_text(condition))
    except Exception:  # the report must not fail because a part of it does
        text = ""
    return f"{name}, {text}" if text else name


def _doing(task):
    """A text about a living task: for how long it has run, what it waits for, and where."""
    kernel_task = task.kernel_task
    if kernel_task is None or task.status is CREATED:
        return "created" if kernel_task is None else "about to begin"
    here = kernel.active()
    text = f"{task.status.name.lower()} for {_seconds(here.now() - task.started_at)}"
    if task is current_task():
        return f"{text}, prints this"
    if kernel_task.cancelled:
        text += ", is being evaporated"
    elif task.held and task.status is RUNNING:
        text += ", is being suspended"
    return _waiting(kernel_task, text, task.status is SUSPENDED)


def _waiting(kernel_task, text, stopped=False):
    """``text``, and what ``kernel_task`` waits for, and where."""
    place = place_of(kernel_task)
    at = f" at {place}" if place else ""
    if stopped:
        return f"{text}, stopped{at}"
    if kernel_task is kernel.current():
        return f"{text}, prints this"
    if kernel_task.ready:
        return f"{text}, can go on{at}"
    return f"{text}, waits for {waits_for(kernel_task)}{at}"


def place_of(kernel_task):
    """The place of ``kernel_task`` in the user's text, ``file:line:column``, or ""."""
    return kernel.reports.where(kernel_task.kernel.frame_of(kernel_task))


def waits_for(kernel_task):
    """A text that says what ``kernel_task``, which is parked, waits for."""
    owner = getattr(kernel_task.why, "__self__", None)
    if isinstance(owner, Branches):
        return "its child" if len(owner.tasks) == 1 else f"the branches of {owner.form.upper()}"
    return cut(kernel_task.describe_why()) or "a wake-up"


def short(value):
    """``value`` printed on one line, cut to `LONGEST` characters."""
    with binding(PRINT_LENGTH, 8, PRINT_LEVEL, 4, PRINT_PRETTY, None):
        return cut(attempt_to_print(prin1_to_string, value))


def cut(text):
    """``text`` on one line, cut to `LONGEST` characters."""
    text = " ".join(str(text).split())
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def _seconds(number):
    return f"{number:.3f}".rstrip("0").rstrip(".") + " s"


# ---------------------------------------------------------------------------------------------------------------- on paper


def shown(lines, file=None):
    """``lines`` as text for the Python file ``file``: with ASCII strokes if its encoding has no others, coloured if it is a terminal."""
    strokes = BOX if _can_write(file, "".join(BOX.values())) else ASCII
    paint = _painter(file)
    text = ""
    for line in lines:
        lead = "".join(strokes[part] for part in line.lead)
        text += (paint(lead, line) if paint else f"{lead}{line.name}  {line.rest}") + "\n"
    return text


def _file_of(stream):
    """The Python file behind an output stream, or ``None``."""
    while hasattr(stream, "sink"):
        stream = stream.sink
    return getattr(stream, "file", None)


def _can_write(file, text):
    try:
        text.encode(getattr(file, "encoding", None) or "utf-8")
    except (UnicodeEncodeError, LookupError):
        return False
    return True


def _painter(file):
    """A function that gives a line its colours, if ``file`` is a terminal and the package rich is there, else ``None``."""
    if file is None or not getattr(file, "isatty", lambda: False)():
        return None
    try:
        from rich.console import Console
        from rich.text import Text
    except ImportError:
        return None
    console = Console(file=file)

    def paint(lead, line):
        word, separator, rest = line.rest.partition(" ")
        style = STYLES[line.status]
        text = Text.assemble((lead, "dim"), (line.name, "bold" if line.alive else "dim"), "  ", (word, style), separator + rest)
        with console.capture() as painted:
            console.print(text, end="", soft_wrap=True, highlight=False)
        return painted.get()

    return paint
