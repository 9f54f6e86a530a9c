"""All examples, by the name of the operator."""

from acting import DESIGNATORS, EPISODES, PROCESS_MODULES, PROJECTION
from lisp_to_hy import hy_text
from plan_language import PLAN_LANGUAGE
from reasoning import PROLOG, UTILITIES
from ros import ACTIONLIB, FRAMES, ROSLISP

EXAMPLES = {
    **PLAN_LANGUAGE,
    **PROLOG,
    **UTILITIES,
    **DESIGNATORS,
    **PROCESS_MODULES,
    **PROJECTION,
    **EPISODES,
    **ROSLISP,
    **ACTIONLIB,
    **FRAMES,
}


def hy_of(example):
    """The Hy text of an example: the one written by hand, or what the Lisp text becomes."""
    return example.hy or hy_text(example.lisp)
