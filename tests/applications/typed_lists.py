"""Lists of typed forms, in the folder ``typed``: what is typed into an application or a library, and what must come.

Between two forms is a blank line. ``;=> REGULAR EXPRESSION`` below a form is what its printed value matches as a whole, white space being one
blank. Where cramhy differs on purpose, ``;~> REGULAR EXPRESSION`` below that is what the original gives.
"""

from __future__ import annotations

import re
from pathlib import Path

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

TYPED = Path(__file__).parent / "typed"


def typed(name, original=False):
    """The forms of a list, each with its answer, or with that of the original."""
    for block in (TYPED / f"{name}.lisp").read_text(encoding="utf-8").strip().split("\n\n"):
        form, _, answers = block.partition("\n;=> ")
        here, _, there = answers.partition("\n;~> ")
        yield re.sub(r"\((lies|stands-in) ", r"(cl-user::\1 ", form), there if original and there else here


def run(session, name, original=False):
    """Type all forms; those whose answers do not match, with what came."""
    wrong = []
    for form, answer in typed(name, original):
        try:
            value = " ".join(prin1_to_string(session.evaluate_text(form)[0]).split())
        except Condition as problem:
            value = f"{type(problem).__name__}: {problem}"
        if not re.fullmatch(answer, value):
            wrong.append(f"{form}\n;=> {value}\nwanted {answer}")
    return wrong
