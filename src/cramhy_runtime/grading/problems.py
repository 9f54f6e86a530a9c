"""What is wrong with an exercise, or with the way it was asked for; not what is wrong with a submission, which is a matter of points."""

from __future__ import annotations


class ExerciseError(Exception):
    """An exercise, or a submission's place, cannot be used. Its text says what is wrong, where, and what to try."""
