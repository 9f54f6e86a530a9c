"""The conditions by which plans fail (cpl.md 4.1).

A ``plan-failure`` is a serious condition and not an error: ``ignore-errors`` and clauses for ``error`` let it pass. In Python it is not
an `Exception`. An error that ends a branch reaches the parent in an envelope, which is a plan failure; a clause of
``with-failure-handling`` for ``error`` looks inside. Policy conditions are neither errors nor plan failures.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Condition, SeriousCondition, SimpleCondition, formatted
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..signatures import Name


class PlanFailure(SeriousCondition):
    """A plan could not reach its goal. In Python, derive your failures from it: ``class DoorStuck(cpl.PlanFailure): pass``."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::PLAN-FAILURE"

    def report(self) -> str:
        return BaseException.__str__(self) if self.args else super().report()


class SimplePlanFailure(SimpleCondition, PlanFailure):
    """A plan failure with a text."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::SIMPLE-PLAN-FAILURE"


class CompositeFailure(PlanFailure):
    """All attempts failed. ``failures`` is a Lisp list of their failures."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::COMPOSITE-FAILURE"
    initargs = {"FAILURES": "failures"}
    failures: Iterable[BaseException] | None = None
    others: Sequence[tuple[str, BaseException]] = ()

    @property
    def exceptions(self) -> list[BaseException]:
        """The failures as a Python list, as Python's ``except`` would see each of them: errors without their envelopes."""
        return [python_exception(failure) for failure in self.failures or ()]

    @property
    def beside(self) -> list[tuple[str, BaseException]]:
        """Pairs (label, failure) that a report shows with it: each failure, then the ``others``, failures of branches beside its own."""
        failures = list(self.failures or ())
        return [*((f"Failure {number} of {len(failures)}", opened(failure)) for number, failure in enumerate(failures, 1)), *self.others]

    @beside.setter
    def beside(self, known: list[tuple[str, BaseException]]) -> None:
        self.others = known[len(list(self.failures or ())) :]


class CommonLispErrorEnvelope(PlanFailure):
    """A plan failure that holds the ``error`` of a child task on its way to the parent."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::COMMON-LISP-ERROR-ENVELOPE"
    initargs = {"ERROR": "error"}
    error: BaseException = None  # type: ignore[assignment]  # it is always given


class PolicyCondition(Condition):
    """A condition about the policy ``name``."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::POLICY-CONDITION"
    initargs = {"NAME": "name"}
    name: Name | None = None


class PolicyNotFound(PolicyCondition):
    """There is no policy called ``name``."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::POLICY-NOT-FOUND"

    def report(self) -> str:
        return formatted("Policy ~a not found.~%", (self.name,))


class PolicyFailure(PolicyCondition):
    """A policy failed. ``parameters`` is a Lisp list of the forms or values that it was used with."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::POLICY-FAILURE"
    initargs = {"NAME": "name", "PARAMETERS": "parameters"}
    parameters: object = None


class PolicyInitFailed(PolicyFailure):
    """The ``init`` clause of a policy did not return true, so its body was not run."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::POLICY-INIT-FAILED"

    def report(self) -> str:
        return formatted("Initialization of policy ~a failed.~%Parameters: ~a~%", (self.name, self.parameters))


class PolicyCheckConditionMet(PolicyFailure):
    """The ``check`` clause of a policy returned true, so its body was evaporated."""

    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::POLICY-CHECK-CONDITION-MET"

    def report(self) -> str:
        return formatted("Policy check condition met for policy ~a.~%Parameters: ~a.~%", (self.name, self.parameters))


def envelope(condition: Condition) -> PlanFailure:
    """``condition`` as a plan failure: itself, or an envelope around it. Envelopes are never nested."""
    if isinstance(condition, PlanFailure):
        return condition
    wrapped = getattr(condition, "envelope", None)  # it came up to Python code, which let it go on: the same envelope again
    if wrapped is None:
        wrapped = CommonLispErrorEnvelope(error=condition)
        wrapped.__cause__ = condition
    return wrapped


def opened(condition: BaseException) -> BaseException:
    """The error in an envelope, with the envelope's source place if it has none of its own. Another condition is returned as it is."""
    if not isinstance(condition, CommonLispErrorEnvelope):
        return condition
    problem = condition.error
    if getattr(problem, "position", None) is None and getattr(condition, "position", None) is not None:
        problem.position = condition.position
    return problem


MISTAKES = (AssertionError, NameError, SyntaxError, MemoryError)
"""Exceptions of Python that say that the program is wrong, or cannot go on. No other attempt makes up for them."""


def is_mistake(failure: object) -> bool:
    """Whether ``failure``, the end of a branch, is one of `MISTAKES`. Forms that try several ways pass it on at once."""
    error = failure.error if isinstance(failure, CommonLispErrorEnvelope) else failure
    return isinstance(error, MISTAKES) or isinstance(getattr(error, "__cause__", None), MISTAKES)


def python_exception(condition: BaseException) -> BaseException:
    """The exception that Python code sees for ``condition``: the error in an envelope, or the exception that Python itself raised."""
    error = opened(condition)
    if error is not condition:
        error.envelope = condition
    cause = error.__cause__
    if cause is None or getattr(cause, "__lisp_condition__", None) is not error:
        cause = error
    for label, other in getattr(error, "beside", ()):  # what else is to be told stands below the traceback
        note = f"{label}: {type(python_exception(other)).__name__}: {other}"
        if note not in getattr(cause, "__notes__", ()):
            cause.add_note(note)
    return cause
