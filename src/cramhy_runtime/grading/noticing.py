"""What a plan does on its way, noticed while a check lets it run in the student's own session: motions, failures and calls of functions.
And functions of the check in the place of others, for exercises in which a student writes tests.

===========  ========================================================================================================================
``motions``  a list of texts. The first word of each is a process module, the others stand in the description of a motion that it got
``failure``  the type of a failure that must come up in the plan, though somebody may handle it
``calls``    for the names of functions: how often each is called, a number or a list of the least and the most
``instead``  for the names of functions: a form that gives a function, which stands in the place of each; ``right`` is the one before
===========  ========================================================================================================================

The process of a submission has none of this: it could forge it.
"""

from __future__ import annotations

import re
from contextlib import contextmanager, suppress

from cramhy_runtime.cpl.hooks import on_fail
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.process_modules.modules import on_process_module_started

from .problems import ExerciseError
from .sentences import Fault, fault

if TYPE_CHECKING:
    from collections.abc import Callable

KEYS = {"motions", "failure", "calls", "instead"}
"""What only a check in a student's session may have."""
_INSTEAD = {
    "lisp": (
        "(let ((right (fdefinition '{name}))) (setf (get '{name} :instead) right (fdefinition '{name}) {form}))",
        "(setf (fdefinition '{name}) (get '{name} :instead))",
    ),
    "hy": ("(do (setv instead-{name} {name} {name} ((fn [right] {form}) {name})) None)", "(setv {name} instead-{name})"),
}
"""Forms, by language, after which another function stands in the place of one, and after which that one stands there again."""
_WORD = re.compile(r"[^\s()<>#\[\],']+")
_COUNTED = {
    "lisp": (
        "(let ((right (fdefinition '{name}))) (setf (get '{name} :noticed) (cons 0 right) (fdefinition '{name}) "
        "(lambda (&rest all) (incf (car (get '{name} :noticed))) (apply right all))))",
        "(destructuring-bind (count . right) (get '{name} :noticed) (setf (fdefinition '{name}) right) (remprop '{name} :noticed) count)",
    ),
    "hy": (
        "(do (setv noticed-{name} [0 {name}]) (defn {name} [#* all #** named] (+= (get noticed-{name} 0) 1) "
        "((get noticed-{name} 1) #* all #** named)))",
        "(do (setv {name} (get noticed-{name} 1)) (get noticed-{name} 0))",
    ),
}
"""Forms, by language, after which the calls of a function are counted, and those that give the number and count no longer."""


@contextmanager
def _no_debugger():
    """In the block an error is raised, and opens no debugger: nobody has typed the form."""
    debugger = conditions.install_debugger(None)
    try:
        yield
    finally:
        conditions.install_debugger(debugger)


class Noticing:
    """A context in which is noticed what ``table`` of a check asks for. evaluate: as of `in_session.faults`. Raises `ExerciseError`."""

    def __init__(self, table: dict[str, Any], evaluate: Callable[[str], list[Any]], language: str):
        self.table, self.evaluate, self.language = table, evaluate, language
        self.motions: list[set[str]] = []
        self.failures: set[str] = set()
        self.calls: dict[str, int] = {}
        self.replaced: list[str] = []
        self.absent: list[str] = []
        """Functions whose place another one should take, and which are not there."""
        for name, kind in (("motions", list), ("calls", dict), ("failure", str), ("instead", dict)):
            if name in table and not isinstance(table[name], kind):
                raise ExerciseError(f"{name} is {table[name]!r}, and not a {kind.__name__}.")

    def __enter__(self) -> Noticing:
        if "motions" in self.table:
            on_process_module_started.add(lambda module, motion: self._motion(module, motion), "check of a task")
        if "failure" in self.table:
            on_fail.add(lambda datum: self._failure(datum), "check of a task")
        for name in self.table.get("calls", ()):
            with suppress(Exception), _no_debugger():  # there may be no such function yet; the plan tells of that
                self.evaluate(_COUNTED[self.language][0].format(name=name))
                self.calls[name] = 0
        for name, form in self.table.get("instead", {}).items():
            try:
                with _no_debugger():
                    self.evaluate(_INSTEAD[self.language][0].format(name=name, form=form))
            except Exception:
                self.absent.append(name)
            else:
                self.replaced.append(name)
        return self

    def __exit__(self, *problem: object) -> None:
        on_process_module_started.remove("check of a task")
        on_fail.remove("check of a task")
        for name in self.replaced:
            self.evaluate(_INSTEAD[self.language][1].format(name=name))
        for name in self.calls:
            self.calls[name] = int(self.evaluate(_COUNTED[self.language][1].format(name=name))[0])

    def _motion(self, module: Any, motion: object) -> None:
        name = str(getattr(getattr(module, "name", module), "name", module))
        self.motions.append({name.lower(), *map(str.lower, _WORD.findall(prin1_to_string(motion)))})

    def _failure(self, datum: Any) -> None:
        from cramhy_runtime.cpl.failures.failure_types import SimplePlanFailure
        from cramhy_runtime.lisp_core.classes import class_name
        from cramhy_runtime.lisp_core.conditions import make_condition
        from cramhy_runtime.lisp_core.packages import is_symbol

        if is_symbol(datum) or isinstance(datum, type):
            datum = make_condition(datum, (), SimplePlanFailure)
        kind = type(datum) if isinstance(datum, BaseException) else SimplePlanFailure
        self.failures |= {str(getattr(class_name(each), "name", each.__name__)).upper() for each in kind.__mro__}
        self.failures |= {each.__name__.upper() for each in kind.__mro__}

    def faults(self) -> list[Fault]:
        """What is missing, and what there was too much of."""
        wrong, left = [], list(self.motions)
        for wanted in self.table.get("motions", ()):
            words = set(wanted.lower().split())
            found = next((motion for motion in left if words <= motion), None)
            if found is None:
                module, *others = wanted.split()
                wrong.append(_missing_motion(module, others, self.motions))
                break
            left.remove(found)
        failure = self.table.get("failure")
        if failure is not None and failure.upper() not in self.failures:
            wrong.append(fault(NO_FAILURE, NO_FAILURE))
        for name, count in self.calls.items():
            low, high = self.table["calls"][name] if isinstance(self.table["calls"][name], list) else [self.table["calls"][name]] * 2
            if not low <= count <= high:
                should = f"{low}" if low == high else f"{low} to {high}"
                called = f"Your plan called {name} {count} time{'s' * (count != 1)}"
                wrong.append(
                    Fault("A function was called too often, or not often enough.", f"{called}.", f"{called}. It should be {should}.")
                )
        return wrong


NO_FAILURE = "The value may be right, but no failure came up in the plan. The task asks for one."


def _missing_motion(module, words, motions):
    got = [motion for motion in motions if module.lower() in motion]
    if not got:
        told = f"The process module {module} has got no motion from your plan."
    elif not words:
        told = f"The process module {module} has got {len(got)} motion{'s' * (len(got) != 1)} from your plan, and that is not enough."
    else:
        told = f"The process module {module} has not got all motions that it should: one described by {' and '.join(words)} is missing."
    return fault("A motion is missing.", told)
