"""Rows of compiled Lisp: each program of ``programs`` beside Python, and the text of a package read, compiled and loaded again."""

from __future__ import annotations

import itertools
import os
import tempfile
import time
from pathlib import Path

from plan_text import plan_text
from programs import programs

from . import Row, peers


_numbers = itertools.count(os.getpid() * 1000)  # so that each file is new


def calling(program):
    def prepare(session):
        session.package = "COMMON-LISP-USER"
        session.evaluate_text(program.lisp)
        function, arguments = session.evaluate_text(f"#'{program.function}")[0], program.arguments

        def work(count):
            for _ in range(count):
                function(*arguments)

        return work

    return prepare


def peer(program):
    return lambda: program.python(*program.arguments)


def loading(again):
    """Work that reads and compiles 400 lines, or loads them again from what was kept; files are new each time."""

    def prepare(session):
        from cramhy_runtime.languages.commonlisp.systems.loader import load_file

        def work(count):
            spent = 0.0
            for _ in range(count):
                number = next(_numbers)
                with tempfile.TemporaryDirectory() as folder:
                    path = Path(folder) / f"plans{number}.lisp"
                    path.write_text(plan_text(400, f"plans-{number}"))
                    if again:
                        load_file(path)
                    begin = time.process_time()
                    load_file(path)
                    spent += time.process_time() - begin
            return spent

        return work

    return prepare


ROWS = [
    *(
        Row(program.name, calling(program), 1, program.goal, "times", times=peer(program), others=peers.sbcl(program))
        for program in programs()
    ),
    Row("400 lines of plans read and compiled", loading(False), 1, unit="ms", slow=True),
    Row("400 lines of plans loaded again", loading(True), 1, unit="ms", slow=True),
]
