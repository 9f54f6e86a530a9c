"""How projection environments and clocks are printed, and described."""

from __future__ import annotations

from ..lisp.data import list_from
from ..lisp.packages import keyword
from ..lisp.printer.printer import define_printer, princ_to_string, print_unreadable
from ..lisp.tools.describing import describe_facts, describe_object
from .clocks import LinearClock, PartiallyOrderedClock
from .environments import ProjectionEnvironment


def print_environment(environment, stream):
    """``#<PROJECTION-ENVIRONMENT NAME>``"""
    print_unreadable(environment, stream, princ_to_string(environment.name), type_=True)


define_printer(ProjectionEnvironment, print_environment)


@describe_object.method(ProjectionEnvironment, None)
def describe_environment(environment, stream):
    """Its name, and what it is made of."""
    return describe_facts(environment, stream, "projection environment", [
        ("Name", environment.name), ("Variables", list_from([symbol for symbol, _ in environment.variables])),
        ("Process modules", list_from(environment.modules)), ("Has a startup form", environment.startup is not None or None),
        ("Has a shutdown form", environment.shutdown is not None or None)])


@describe_object.method(LinearClock, None)
def describe_linear(clock, stream):
    """The time that it shows."""
    return describe_facts(clock, stream, "projection clock", [("Time", clock.time)])


@describe_object.method(PartiallyOrderedClock, None)
def describe_partially_ordered(clock, stream):
    """The time that it shows, the moments that are waited for, and whether it is enabled."""
    return describe_facts(clock, stream, "projection clock", [
        ("Time", clock.time), ("Waits until", list_from(clock.ends)),
        ("State", keyword("DISABLED" if clock.disabled else "ENABLED"))])
