"""Episodes: the knowledge of what one run of a plan did. Every top-level is one.

An episode is made when somebody asks for it, from the task at the root of the plan, which knows when it began and ended and keeps
the tree of what ran (``cpl/tree/finished_plans.py``). So a plan that nobody asks about pays for two assignments. The plan that runs, the
one that ended last, and the last one of each name can be asked for; others live as long as somebody holds their episode.

``*episode-knowledge*`` is the episode that queries are about: within a plan that plan's own, elsewhere nil, unless one is chosen by
`with_episode_knowledge`. Lazy lists that are made within go on asking the chosen one when their elements are wanted later (in the
original they ask whatever is current then). Times are seconds as ``cut:current-timestamp`` gives them. Source:
projection-and-events.md C1.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import Cell
from cramhy_runtime import kernel

from cramhy_runtime.cpl.tree import finished_plans
from ..cpl.current import current_task
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.cpl.forms.plans import plan_property
from ..cpl.statuses import DEAD
from ..cpl.task_variables import define_task_state, inherit
from cramhy_runtime.cpl.tasks.tasks import AbstractTask
from cramhy_runtime.lisp_core.conditions import SimpleError, as_name, error, type_error
from cramhy_runtime.lisp_core.data import UNBOUND
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ..utilities.lazy_lists import with_lazy_list_dynamic_environment
from ..utilities.small_functions import current_timestamp
from .symbols import CET, sym
from .trees import task_tree

TOP_LEVEL_PLAN = keyword("TOP-LEVEL-PLAN")


class EpisodeKnowledge:
    """What all episodes share: ``plan_name``, ``zero_time`` and ``end_time`` (seconds; nil while it runs), ``traces`` (a dict name of
    fluent → list of `tracing.TracedFluent`), and ``tree()``, the root node of its task tree or ``None``."""

    lisp_name = "CRAM-EXECUTION-TRACE::EPISODE-KNOWLEDGE"
    running = False

    def __init__(self, plan_name=None):
        self.plan_name = plan_name
        self.zero_time = self.end_time = None
        self.traces = {}

    def tree(self):
        return None


class LiveEpisodeKnowledge(EpisodeKnowledge):
    """The episode of a plan of this session; without a task, the empty one of a plan that did not run yet."""

    lisp_name = "CRAM-EXECUTION-TRACE::LIVE-EPISODE-KNOWLEDGE"

    def __init__(self, plan_name=None, task=None):
        super().__init__(plan_name)
        self.task = task
        self.recorder = None  # while its fluents are traced
        self.nodes = {}  # node of the plan's tree → node of the episode's
        self.root = None
        if task is not None:
            self.zero_time = _timestamp(kernel.now() if task.started_at is None else task.started_at)

    def tree(self):
        return task_tree(self)

    @property
    def running(self):
        return self.task is not None and self.task.status not in DEAD

    @property
    def end_time(self):
        return None if self.task is None or self.task.ended_at is None else _timestamp(self.task.ended_at)

    @end_time.setter
    def end_time(self, seconds):
        """Its task knows when it ends."""


def _timestamp(seconds):
    """``seconds`` of the kernel's clock as a time stamp, to the millisecond."""
    return float(round(seconds + (current_timestamp() - kernel.now()), 3))


def stamp(task, seconds):
    """A time that ``task`` tells, as a time stamp; nil if it tells none."""
    return seconds if seconds is None or not isinstance(task, AbstractTask) else _timestamp(seconds)


def episode_of(task):
    """The episode of the plan at whose root ``task`` is; what was stored in its place, an episode, is itself."""
    if task is None or isinstance(task, EpisodeKnowledge):
        return task
    found = task.__dict__.get("episode")
    if found is None:
        found = task.episode = LiveEpisodeKnowledge(task.__dict__.get("plan_name"), task)
    return found


# ------------------------------------------------------------------------------------------------------------ which episode


def running_episode():
    """The episode of the plan that the current task belongs to, or ``None``."""
    task = current_task() if kernel.active() is not None else None
    if task is None:
        return None
    while task.parent is not None:
        task = task.parent
    return episode_of(task)


_chosen = Cell(None, fresh=True)  # what the current task has bound or assigned the variable to


def current_episode():
    """The value of ``*episode-knowledge*``."""
    return running_episode() if _chosen.value is None else _chosen.value


def _choose(episode):
    # A plan's own episode is what the variable is without a choice: to put that back is to choose nothing.
    _chosen.value = None if episode is None or episode.running else episode


def last_episode():
    """The value of ``*last-episode-knowledge*``: the episode of the plan that ended last, or ``None``."""
    return episode_of(finished_plans.newest.value)


def _set_last(episode):
    finished_plans.newest.value = episode


EPISODE = define_task_state(CET, "*EPISODE-KNOWLEDGE*", current_episode, lambda new: _choose(checked(new, True)))
LAST_EPISODE = define_task_state(CET, "*LAST-EPISODE-KNOWLEDGE*", last_episode, lambda new: _set_last(checked(new, True)))
inherit(EPISODE, None, within_plans=True)


def checked(episode, or_nil=False):
    """``episode``, when it is one; else the type-error that says how to choose one."""
    if isinstance(episode, EpisodeKnowledge) or (or_nil and (episode is None or episode is UNBOUND)):
        return episode
    return type_error(
        episode,
        sym("CRAM-EXECUTION-TRACE::EPISODE-KNOWLEDGE"),
        "\n(Which episode is meant? Write (with-last-episode-knowledge ...) around the query, or give one as last argument.)",
    )


def get_top_level_episode_knowledge(name):
    """The episode of the last run of the top-level plan ``name`` (nil: of the last without a name); an empty one before its first run."""
    if as_name(name) in finished_plans.by_name:
        return episode_of(finished_plans.by_name[name])
    if plan_property(name, "PLAN-TYPE") is TOP_LEVEL_PLAN:
        return register_top_level_episode_knowledge(name)
    known = [prin1_to_string(key) for key in finished_plans.by_name if key is not None]
    near = near_names(prin1_to_string(name), known, 1)
    hint = (
        f"Did you mean {near[0]}?"
        if near
        else f"There are episodes of {', '.join(known)}."
        if known
        else "No plan with a name has run yet; the last plan of all is in (with-last-episode-knowledge ...)."
    )
    return error(SimpleError("Accessing top-level episode-knowledge for unregisterd top-level plan ~a.", name), hint=hint)


def register_top_level_episode_knowledge(name):
    """Let an empty episode stand under ``name``; returns it."""
    finished_plans.by_name[as_name(name)] = episode = LiveEpisodeKnowledge(name)
    return episode


def with_episode_knowledge(episode, body):
    """Values of ``body()`` with ``*episode-knowledge*`` bound to ``episode``, also for lazy lists that it makes."""
    checked(episode)
    with binding(EPISODE, episode):
        return with_lazy_list_dynamic_environment([(EPISODE, lambda: episode)], body)


def with_last_episode_knowledge(body):
    """Values of ``body()`` about the plan that ended last."""
    return with_episode_knowledge(last_episode(), body)


def with_top_level_episode_knowledge(name, body):
    """Values of ``body()`` about the last run of the top-level plan ``name``."""
    return with_episode_knowledge(get_top_level_episode_knowledge(name), body)
