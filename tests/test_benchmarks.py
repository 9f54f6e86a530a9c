"""The programs that the benchmarks time give the same results in Lisp as in Python."""

import importlib
import sys
from pathlib import Path

import pytest

from cramhy_runtime.repl.session import Session

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


def _programs():
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return importlib.import_module("programs").programs()
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.mark.parametrize("program", _programs(), ids=lambda program: program.function)
def test_a_program_gives_what_its_peer_gives(program):
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text(program.lisp)
    arguments = [min(argument, 60) for argument in program.arguments]
    text = " ".join(map(str, arguments))
    assert session.evaluate_text(f"({program.function} {text})")[0] == program.python(*arguments)
