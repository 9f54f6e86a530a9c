"""ROS commands typed at the prompt: ``rosservice call /clear`` without a second terminal, on the graph of this process."""

from __future__ import annotations


from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError

PATIENCE = 5.0
"""Seconds of virtual time after which a command ends that would go on for ever, and so fill the screen at once."""


def is_command(line):
    """Whether a line typed at the prompt is a ROS command and no Lisp."""
    if not line.startswith("ros") or "(" in line:
        return False
    from cramhy_runtime.ros_tools.running import TOOLS

    return line.split(None, 1)[0] in TOOLS


def run_line(line, write):
    """Carry out a command that was typed at the prompt, until Ctrl-C. write: a function of a text, which gets what it prints and complains
    of."""
    import shlex

    from cramhy_runtime.ros_tools import local_graph, running

    try:
        words = shlex.split(line)
    except ValueError as problem:
        return write(f"{line.split()[0]}: {problem}\n")
    patience = PATIENCE if kernel.active().clock.virtual else None
    try:
        conditions.handler_case(
            [(SimpleError, lambda problem: write(f"ERROR: {problem.report()}\n"))],
            lambda: running.run(words, running.Terminal(write, write, lambda: local_graph.reached(patience))),
        )
    except (local_graph.OutOfTime, kernel.Interrupted, kernel.Abandoned):
        pass  # Ctrl-C is the ordinary end of a command that goes on for ever
