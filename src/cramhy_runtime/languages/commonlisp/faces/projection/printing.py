"""How projection environments and clocks are printed, and described."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import princ_to_string
from ...tools.describing import describe_facts, describe_object
from cramhy_runtime.projection.clocks import LinearClock, PartiallyOrderedClock
from cramhy_runtime.projection.environments import ProjectionEnvironment


def print_environment(environment, stream):
    """``#<PROJECTION-ENVIRONMENT NAME>``"""
    print_unreadable(environment, stream, princ_to_string(environment.name), type_=True)


def describe_environment(environment, stream):
    """Its name, and what it is made of."""
    return describe_facts(
        environment,
        stream,
        "projection environment",
        [
            ("Name", environment.name),
            ("Variables", list_from([symbol for symbol, _ in environment.variables])),
            ("Process modules", list_from(environment.modules)),
            ("Has a startup form", environment.startup is not None or None),
            ("Has a shutdown form", environment.shutdown is not None or None),
        ],
    )


def describe_linear(clock, stream):
    """The time that it shows."""
    return describe_facts(clock, stream, "projection clock", [("Time", clock.time)])


def describe_partially_ordered(clock, stream):
    """The time that it shows, the moments that are waited for, and whether it is enabled."""
    return describe_facts(
        clock,
        stream,
        "projection clock",
        [("Time", clock.time), ("Waits until", list_from(clock.ends)), ("State", keyword("DISABLED" if clock.disabled else "ENABLED"))],
    )


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(ProjectionEnvironment, print_environment)
    describe_object.method(ProjectionEnvironment, None)(describe_environment)
    describe_object.method(LinearClock, None)(describe_linear)
    describe_object.method(PartiallyOrderedClock, None)(describe_partially_ordered)
