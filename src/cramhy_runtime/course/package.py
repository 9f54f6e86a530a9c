"""The Lisp package COURSE with the function ``check``, for prompts and notebooks that are not those of ``cramhy learn``.

    (course:check "rectangle")             tells whether the task is solved, and gives T or NIL
    (course:check "rectangle" :hy)         the same for a solution in Hy

In Hy it is the function `check` of this module.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.packages import on_demand, registered
from cramhy_runtime.languages.commonlisp.packages.face_definition import define_face
from cramhy_runtime.languages.commonlisp.streams import streams

from . import checking

NAME = "COURSE"


def check(name, language="lisp"):
    """Check the task called NAME in this session, print what is wrong, and return whether it is solved.

    language: :lisp or :hy, in which the solution is written. Source: the pages in docs/tutorials.
    """
    called, wanted = (str(getattr(word, "name", word)).lower() for word in (name, language))
    found = checking.check(called, language=wanted, caller=sys._getframe(1))
    output = streams.STANDARD_OUTPUT.value
    output.fresh_line()
    output.write("".join(f"{line}\n" for line in ([] if found["passed"] else ["Not yet."]) + found["told"]))
    output.flush()
    return found["passed"] or None


def define() -> None:
    """Make the package, once in each image."""
    on_demand.pop(NAME, None)
    if registered(NAME) is None:
        define_face(NAME, functions={"check": check}, export="check")
