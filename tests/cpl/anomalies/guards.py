"""Guarded bodies: cleanup forms that say whether they ran once, and after those of their branches (law 2).

``(guarded name form...)`` is ``(progn form...)`` in an ``unwind-protect`` whose cleanup form reports here; that of ``(guarded-slowly
name seconds form...)`` takes time, so that something can happen to it too. A guard's parent is the innermost one that was open in its
task, or in a task above, when it began.
"""

from __future__ import annotations

from contextlib import contextmanager

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.packages.face_definition import define_face
from cramhy_runtime.testing.labels import label

MACROS = """
(defmacro guarded (name &body body)
  (let ((guard (gensym)))
    `(let ((,guard (anomalies:enter ',name)))
       (unwind-protect (progn ,@body)
         (anomalies:leave ,guard)
         (anomalies:left ,guard)))))

(defmacro guarded-slowly (name seconds &body body)
  (let ((guard (gensym)))
    `(let ((,guard (anomalies:enter ',name)))
       (unwind-protect (progn ,@body)
         (anomalies:leave ,guard)
         (unwind-protect (sleep ,seconds)
           (anomalies:left ,guard))))))
t
"""


class Guard:
    def __init__(self, name, task, parent):
        self.name, self.task, self.parent = name, label(task), parent
        self.tasks_before = task.kernel._born  # tasks started later are below this guard
        self.state = "open"
        self.children = []
        if parent is not None:
            parent.children.append(self)

    def __str__(self):
        return f"{self.name} in {self.task}"


class Guards:
    """The guards of one run, and what went wrong with them."""

    def __init__(self):
        self.all = []
        self.wrong = []

    def finish(self):
        """What went wrong, now that the run is over."""
        return self.wrong + [
            f"the cleanup of {guard} did not {'run' if guard.state == 'open' else 'end'}" for guard in self.all if guard.state != "left"
        ]


current = Guards()


def begin():
    """A new run."""
    global current
    current = Guards()
    return current


def enter(name):
    task = kernel.current()
    stack = task.local.__dict__.setdefault("guards", [])
    holder = task
    above = stack
    while not above and holder.parent is not None:
        above = [guard for guard in getattr(holder.parent.local, "guards", ()) if guard.tasks_before <= holder.id]
        holder = holder.parent
    guard = Guard(getattr(name, "name", name).lower(), task, above[-1] if above else None)
    current.all.append(guard)
    stack.append(guard)
    return guard


def leave(guard):
    if guard.state != "open":
        current.wrong.append(f"the cleanup of {guard} ran again")
    guard.state = "leaving"
    current.wrong += [f"the cleanup of {guard} began before that of {child} was over" for child in guard.children if child.state != "left"]
    return None


def left(guard):
    guard.state = "left"
    kernel.current().local.guards.remove(guard)
    return None


@contextmanager
def guarded(name):
    """The same for plans in Python."""
    guard = enter(name)
    try:
        yield
    finally:
        leave(guard)
        left(guard)


def define():
    """Make the package ANOMALIES, once."""
    define_face("ANOMALIES", functions={"enter": enter, "leave": leave, "left": left}, export="enter leave left")
