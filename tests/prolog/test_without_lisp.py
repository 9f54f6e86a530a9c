"""What a process of Python has that never loads Common Lisp: comparisons, and errors that tell their own cause."""

import subprocess
import sys

PROGRAM = """
import fractions, warnings
from cramhy_runtime import cpl
from cramhy_runtime.designators import Motion
from cramhy_runtime.process_modules import execute, perform
from cramhy_runtime.prolog import P, V, findall, holds, kw
assert findall(V.x, P.member(V.x, [1, 3, 2.25]), V.x < 2.5) == [1, 2.25]
assert findall(V.x, P.member(V.x, [1, 3.5]), V.x >= 2) == [3.5]
assert holds(P["<="](fractions.Fraction(1, 2), 0.5)) and holds(P[">"](1, fractions.Fraction(1, 2))) and not holds(P["<"](1, 1.0))
assert not holds(P["<"]("a", 3))
for wrong in (lambda: cpl.sleep("3"), lambda: cpl.sleep(None), lambda: cpl.fail(3), lambda: perform("drive"), lambda: execute(3, Motion()),
              lambda: execute("arm", 3)):
    try:
        wrong()
    except BaseException as problem:
        print(type(problem).__name__, " ".join(str(problem).split()))
"""


def test_numbers_of_two_kinds_compare_and_a_mistake_outside_of_a_plan_is_told_itself():
    told = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=60)
    assert told.returncode == 0, told.stderr
    assert told.stdout.splitlines() == [
        'TypeError_ The value "3" is not of type REAL',
        "TypeError_ The value NIL is not of type REAL",
        "CaseFailure 3 fell through ETYPECASE expression. Wanted one of (CONDITION SYMBOL STRING).",
        "TypeError 'drive' is no designator, and cannot be performed. Make one: Motion(type=kw.driving).",
        "TypeError 3 is no process module. Decorate a function with @process_module.",
        "TypeError 3 is no designator, and cannot be performed. Make one: Motion(type=kw.driving).",
    ]
    assert " ".join(told.stderr.split()) == (
        "WARNING: An error occurred while executing the lisp predicate `<': `The value \"a\" is not of type REAL'"
    )
