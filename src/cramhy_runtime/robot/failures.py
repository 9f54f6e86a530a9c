"""The failures of a robot, which are those of CRAM's package COMMON-FAIL: ``except robot.failures.PerceptionObjectNotFound:``.

Low-level failures come from the parts of the robot: it would touch something, sees nothing, does not reach. High-level ones come from
plans that have tried all that they know. All of them are a `SimplePlanFailure`.
"""

from __future__ import annotations

from cramhy_runtime.cpl import SimplePlanFailure

from .libraries import failure_class


class _Failure:
    """The class of the current image that has the attribute's name."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: object, owner: type | None = None) -> type[SimplePlanFailure]:
        found: type[SimplePlanFailure] = failure_class(self.name)
        return found


class Failures:
    """The classes of failures, as attributes."""

    LowLevelFailure = _Failure()
    NavigationLowLevelFailure = _Failure()
    NavigationPoseUnreachable = _Failure()
    NavigationGoalNotReached = _Failure()
    PerceptionLowLevelFailure = _Failure()
    PerceptionObjectNotFound = _Failure()
    PtuLowLevelFailure = _Failure()
    PtuGoalNotReached = _Failure()
    PtuGoalUnreachable = _Failure()
    ManipulationLowLevelFailure = _Failure()
    ManipulationPoseUnreachable = _Failure()
    ManipulationGoalNotReached = _Failure()
    GripperLowLevelFailure = _Failure()
    GripperClosedCompletely = _Failure()
    GripperGoalNotReached = _Failure()
    TorsoLowLevelFailure = _Failure()
    TorsoGoalNotReached = _Failure()
    TorsoGoalUnreachable = _Failure()
    HighLevelFailure = _Failure()
    ObjectUnreachable = _Failure()
    ObjectUnfetchable = _Failure()
    ObjectUndeliverable = _Failure()
    ObjectNowhereToBeFound = _Failure()


failures = Failures()
"""``robot.failures``."""
