"""Some 650 small programs answer as in SBCL: scope, closures, order, lambda lists, values, exits, conditions, places, macros.

``sbcl/compiler.txt`` holds the programs with what SBCL 2.2.9 answered (``record.lisp`` made it); they are run in order in one
session, by the compiler and the whole image.
"""

import pytest
from sbcl_answers import line, recorded

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session, condition_of

PROGRAMS = recorded("compiler.txt")


@pytest.fixture(scope="module")
def answer():
    session = Session(time="virtual", turtlesim=False)
    pretty = sym("*PRINT-PRETTY*")
    before, pretty.value = pretty.value, None

    def ask(text):
        try:
            values = session.evaluate_text(text)
        except (Condition, Exception) as problem:
            condition = condition_of(problem)
            return f"!! {condition.lisp_name.rpartition(':')[2]} {line(condition.report())}"
        return ("=> " + " ; ".join(line(prin1_to_string(value)) for value in values)).rstrip()

    yield ask
    pretty.value = before
    kernel.stop()


@pytest.mark.parametrize(("program", "wanted"), PROGRAMS, ids=[str(number) for number in range(len(PROGRAMS))])
def test_the_answer_is_that_of_sbcl(answer, program, wanted):
    assert answer(program) == wanted
