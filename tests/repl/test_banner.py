"""The two lines that a prompt begins with where somebody sits at a terminal, and nowhere else."""

from __future__ import annotations

import json

import hy
import pytest

from cramhy_runtime import __version__
from cramhy_runtime.repl import banner

LISP = f"cramhy {__version__}, the plan language of CRAM\nhelp tells what to type; exit leaves\n"
HY = f"cramhy {__version__} in Hy {hy.__version__}\n(in-package :name) leads to Common Lisp\n"


@pytest.mark.soak
@pytest.mark.parametrize("editor", [False, True], ids=["plain", "edited"])
@pytest.mark.parametrize("arguments, expected", [([], LISP), (["--hy"], HY), (["--quiet"], ""), (["--hy", "--quiet"], "")])
def test_a_terminal_is_greeted_in_two_lines(arguments, expected, editor):
    pytest.importorskip("termios", reason="a pseudo-terminal needs termios, which this system lacks")
    if editor:
        pytest.importorskip("prompt_toolkit")
    from .terminal import Terminal

    with Terminal("repl", *arguments, editor=editor) as terminal:
        assert terminal.expect("> ") in (f"{expected}=> ", f"{expected}CL-USER> ")
        if not editor:
            assert b"\x1b" not in terminal.raw


def test_it_fits_into_forty_columns():
    for text in (banner.of_lisp(), banner.of_hy()):
        assert [line for line in text.split("\n") if len(line) > 40] == []
        assert text.count("\n") == 1


@pytest.mark.soak
def test_a_pipe_is_not_greeted(cramhy):
    assert cramhy("repl", input="(+ 1 1)\n").stdout == "CL-USER> 2\nCL-USER> "
    assert "cramhy" not in cramhy("repl", "--hy", input="(+ 1 1)\n").stdout


def test_json_is_not_greeted(cramhy):
    lines = cramhy("eval", input='{"form": "(+ 1 1)"}\n').stdout.splitlines()
    assert [json.loads(line)["values"] for line in lines] == [["2"]]
