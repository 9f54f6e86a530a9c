"""What the tasks of plans do: each that starts, each change of its status, what it waits for and where, what became of it.

That a task starts or changes is told by the plan itself (``cpl/tasks/task_observers.py``), so that none is lost, however short it lives;
all else is read off the tasks at the end of an instant, as ``describe-task-tree`` reads it, and only of those that ran meanwhile. Dead
tasks are remembered as texts, so nothing of a plan is held; the oldest dead are forgotten when there are too many. Children die
before their parents (law 1), so whoever is still known has known parents.
"""

from __future__ import annotations

import math
import re
from collections import deque

from .. import kernel
from cramhy_runtime.cpl.tree import finished_plans
from cramhy_runtime.cpl.tasks.task_observers import follow, unfollow
from ..cpl.statuses import CREATED, EVAPORATED, FAILED, RUNNING, SUCCEEDED
from cramhy_runtime.cpl.tasks.tasks import AbstractTask
from cramhy_runtime.cpl.tree.tree_report import Forest, failure, living_plans, place_of, title, waits_for
from cramhy_runtime.lisp_core.data import all_values
from ..ros.messages import message_class_exact
from ..ros.wire import ros_text
from .texts import value_text

MOST_DEAD = 500
"""Dead tasks that are remembered."""
MOST_EVENTS = 5000
"""Events that may wait for the end of an instant; with more, the tasks are looked at before it."""
MOST_SHORT_LIVED = 50
"""Tasks that began and died between two looks, of which a page is told. A recording is told of all."""

_operator = re.compile(r"\[(?P<form>.+?)(-CHILD-#\d+/\d+)?\](-\d+)?$")


class Living:
    """What is known of a task that lives: the message that tells it last, and how often it had been woken then."""

    __slots__ = ("task", "message", "ticket")

    def __init__(self, task, message):
        self.task, self.message, self.ticket = task, message, None


class Plans:
    """Watches the tasks of all plans of the active kernel. `take` gives what is new as a ``cramhy_msgs/TaskTree``, or ``None``."""

    def __init__(self):
        self.kernel = kernel.active()
        self.task_type, self.type = message_class_exact("cramhy_msgs/Task"), message_class_exact("cramhy_msgs/TaskTree")
        self.events = []  # (task, its status then), in order
        self.living = {}  # task -> Living
        self.dead = deque()  # ids, the oldest first
        self.roots = []
        self.every = True  # whether each change is wanted, and not only what has come of them
        self.waiting = False  # a look before the end of the instant was asked for
        self.overflow = None
        self.noting = self.note  # one object for all tasks

    def begin(self, overflow=None):
        """Watch from now on. ``overflow()`` is called in the scheduler when so much happens at one instant that somebody has to look."""
        self.overflow = overflow
        finished_plans.observe(self)
        for root in living_plans():
            self.begins(root, None)
            tasks = list(root.children)
            for task in tasks:
                self.starts(task)
                tasks += task.children

    def finished(self):
        """The plans that ended before anybody watched, as far as the session remembers them, as a message like those of `take`."""
        roots = dict.fromkeys([*finished_plans.by_name.values(), finished_plans.newest.value])
        roots = [root for root in roots if isinstance(root, AbstractTask) and root.dead and root.kernel_task.kernel is self.kernel]
        forest = Forest(roots)
        tasks = {*roots, *(task for children in forest.children.values() for task in children)}
        tasks = sorted((task for task in tasks if task.dead and task.kernel_task is not None), key=lambda task: task.kernel_task.id)
        told = [self._ended(Living(task, self._first_message(task))) for task in tasks[-MOST_DEAD:]]
        return self.type(stamp=self.kernel.now(), tasks=told) if told else None

    def end(self):
        """Watch no more."""
        finished_plans.observe_no_more(self)
        for root in self.roots:
            unfollow(root, self.starts)
        for living in self.living.values():
            if living.task.observers and self.noting in living.task.observers:
                living.task.observers.remove(self.noting)
        self.events, self.living, self.roots = [], {}, []

    # ---------------------------------------------------------------------------------------- called by the plans themselves

    def begins(self, task, name):
        if kernel.active() is self.kernel:
            follow(task, self.starts)
            self.roots = [root for root in self.roots if not root.dead] + [task]
            self.starts(task)

    def beside(self, task):
        self.begins(task, None)

    def made(self, task):
        """It is told when it starts."""

    def ended(self, task, name):
        """Its end was told; that nothing else happens shall not keep it from those who look on."""
        if kernel.active() is self.kernel and self.overflow is not None:
            self.kernel.post(self.overflow)

    def starts(self, task):
        if task.observers is None:
            task.observers = [self.noting]
        elif self.noting not in task.observers:
            task.observers.append(self.noting)
        else:
            return
        self.note(task)

    def note(self, task):
        events = self.events
        events.append((task, task.status))
        if task.dead:  # whoever wakes up or suspends the dead tells it to observers; to us it is over
            task.observers = [observer for observer in task.observers if observer is not self.noting]
        if len(events) > MOST_EVENTS and not self.waiting and self.overflow is not None:
            self.waiting = True
            self.kernel.post(self.overflow)

    # -------------------------------------------------------------------------------------------- what is new

    def take(self):
        """What has happened since the last call: every task that began, changed or ended, those that ended with their result."""
        self.waiting = False
        told = self._events() if self.events else []
        for living in list(self.living.values()):
            kernel_task = living.task.kernel_task
            if kernel_task.ticket != living.ticket or kernel_task.ready:
                changed = self._looked_at(living)
                if changed is not None:
                    told.append(changed)
        removed = []
        while len(self.dead) > MOST_DEAD:
            removed.append(self.dead.popleft())
        if not told and not removed:
            return None
        return self.type(stamp=self.kernel.now(), tasks=told, removed=removed)

    def _events(self):
        events, self.events = self.events, []
        last = {task: index for index, (task, status) in enumerate(events)}
        if not self.every:
            events = self._thinned(last)
            last = {task: index for index, (task, status) in enumerate(events)}
        told = []
        for index, (task, status) in enumerate(events):
            if task.kernel_task is None:
                if not task.dead:  # about to start: its parent is in the middle of that
                    self.events.append((task, status))
                continue
            if last[task] != index and status is CREATED:
                continue  # it runs at once
            living = self.living.get(task)
            if living is None:
                living = self.living[task] = Living(task, self._first_message(task))
            if last[task] == index and task.dead:
                del self.living[task]
                told.append(self._ended(living))
            else:
                message = living.message = living.message.copy()
                message.state = status.name
                living.ticket = None
                if last[task] == index:
                    self._looked_at(living)
                told.append(living.message)
        return told

    def _thinned(self, last):
        """The last event of each task in ``last``, task → place in order; of those that came and went meanwhile, the newest."""
        short_lived = [task for task in last if task.dead and task not in self.living and task.kernel_task is not None]
        dropped = set(sorted(short_lived, key=last.get)[:-MOST_SHORT_LIVED])  # children die first, so nobody's parent is dropped
        return [(task, task.status) for task in sorted(last, key=last.get) if task not in dropped]

    def _first_message(self, task):
        parent = task.parent
        name = task.plain_name
        form = _operator.match(name)
        return self.task_type(
            id=str(task.kernel_task.id),
            parent="" if parent is None or parent.kernel_task is None else str(parent.kernel_task.id),
            name=ros_text(title(task)),
            operator=ros_text(form["form"] if form else name),
            state=RUNNING.name,
            waits_for="",
            place="",
            began=task.started_at if task.started_at is not None else math.nan,
            ended=math.nan,
            result="",
        )

    def _looked_at(self, living):
        """Its new message if it waits for something else, or elsewhere, than it did; else ``None``."""
        task, kernel_task = living.task, living.task.kernel_task
        living.ticket = kernel_task.ticket
        reason = place = ""
        if task.status is not CREATED:
            place = place_of(kernel_task)
            if task.status is RUNNING and not kernel_task.ready and kernel_task is not self.kernel.current:
                reason = waits_for(kernel_task)
        before = living.message
        reason, place = ros_text(reason), ros_text(place or before.place)
        if (reason, place, task.status.name) == (before.waits_for, before.place, before.state):
            return None
        message = living.message = before.copy()
        message.waits_for, message.place, message.state = reason, place, task.status.name
        return message

    def _ended(self, living):
        task, message = living.task, living.message.copy()
        message.state, message.waits_for, message.ended = task.status.name, "", task.ended_at
        if task.status is SUCCEEDED:
            message.result = ros_text(", ".join(map(value_text, all_values(task.result))))
        elif task.status is FAILED:
            text, place = failure(task)
            message.result, message.place = ros_text(text), ros_text(place) or message.place
        elif task.status is EVAPORATED:
            message.result = ""
        self.dead.append(message.id)
        return message
