"""The reader and LOOP, asked what SBCL was asked: ``sbcl/reader.txt`` and ``sbcl/loop.txt`` hold forms with its answers."""

import re
from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import all_values
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.lisp_core.packages import find_package, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.reader.reader import Reader

FOLDER = Path(__file__).parent / "sbcl"


def recorded(name):
    lines = (FOLDER / name).read_text().splitlines()
    return list(zip(lines[::2], lines[1::2], strict=True))


def answer(form):
    """What our evaluator says to ``form``, in the notation of ``sbcl/record.lisp``."""
    kernel.start(clock="virtual")
    boot()
    with binding(sym("*PACKAGE*"), find_package("COMMON-LISP-USER"), sym("*PRINT-PRETTY*"), None):
        try:
            found = all_values(evaluator.evaluate(Reader(form).read()))
        except Condition as condition:
            return f"!! {condition.lisp_name.rpartition(':')[2]} {condition.report()}"
        return "=> " + " ; ".join(prin1_to_string(value) for value in found)


def comparable(text):
    """``text`` on one line, without what names a stream, an address or the place where SBCL bound the value."""
    text = re.sub(r"\s*Stream: #<.*", "", " ".join(text.split()))
    text = re.sub(r"#<[^>]*>", "#<>", text)
    return re.sub(r" when binding SB-\S+", "", text)


@pytest.mark.soak(all_but=23)
@pytest.mark.parametrize("form, expected", recorded("reader.txt"))
def test_the_reader_answers_as_in_sbcl(form, expected):
    assert comparable(answer(form)) == comparable(expected)


@pytest.mark.soak(all_but=22)
@pytest.mark.parametrize("form, expected", recorded("loop.txt"))
def test_loop_answers_as_in_sbcl(form, expected):
    assert comparable(answer(form)) == comparable(expected)
