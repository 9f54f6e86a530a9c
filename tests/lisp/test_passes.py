"""The compiler's passes: programs mean the same with each of them off, and with all of them off.

``sbcl/passes.txt`` has programs for each pass, ``sbcl/compiler.txt`` those of all chapters, both with what SBCL 2.2.9 answered. In short, each
pass that is off alone meets its own programs and every eleventh of the others; with CRAMHY_SOAK=1 (``make soak``) all of
them.
"""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from sbcl_answers import line, recorded
from systems import SOAK

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.compiler import passes
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import compiler
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session, condition_of

NAMES = sorted(passes.NAMES)
EVERY = 1 if SOAK else 11


def sections():
    """Name of a pass → the (program, answer) pairs of its section."""
    found, name = {}, None
    for program, answer in recorded("passes.txt"):
        if program.startswith("'"):
            name = program[1:]
        else:
            found.setdefault(name, []).append((program, answer))
    return found


SECTIONS = sections()
CHAPTERS = recorded("compiler.txt")


@pytest.fixture
def with_passes():
    """A function: let these passes be on until the test is over."""
    compiler()
    before = frozenset(passes.ON)
    yield lambda on: passes.switch(frozenset(on))
    passes.switch(before)


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


REPEATED: list = []


@pytest.fixture
def chapters(answer):
    """The programs of all chapters that have been run, in order, and answer the same when they are run again."""
    if not REPEATED:
        for _ in range(2):
            REPEATED[:] = [(program, wanted) for program, wanted in CHAPTERS if answer(program) == wanted]
        assert len(REPEATED) > 0.99 * len(CHAPTERS)
    return REPEATED


def wrong(answer, programs):
    """(program, SBCL's answer, ours) of those that differ."""
    return [(program, wanted, ours) for program, wanted in programs if (ours := answer(program)) != wanted]


def test_each_pass_has_programs():
    assert sorted(SECTIONS) == NAMES


def test_programs_answer_as_in_sbcl_with_all_passes(answer):
    assert wrong(answer, [each for name in NAMES for each in SECTIONS[name]]) == []


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", NAMES)
def test_programs_answer_as_in_sbcl_with_one_pass_off(answer, chapters, with_passes, name):
    with_passes(passes.NAMES - {name})
    assert wrong(answer, [*SECTIONS[name], *chapters[NAMES.index(name) % EVERY :: EVERY]]) == []


@pytest.mark.soak
@pytest.mark.parametrize("on", [frozenset(), *(frozenset({name}) for name in NAMES if SOAK)], ids=lambda on: ",".join(on) or "none")
def test_programs_answer_as_in_sbcl_with_nearly_no_pass(answer, chapters, with_passes, on):
    with_passes(on)
    assert wrong(answer, [*(each for name in NAMES for each in SECTIONS[name]), *chapters]) == []


@pytest.mark.soak(all_but=7)
@pytest.mark.parametrize("name", NAMES)
def test_a_pass_changes_the_code_of_its_programs(answer, with_passes, name, monkeypatch):
    generated = compiler().generated

    def code(program):
        made = []

        def noted(*arguments):
            made.append(repr(found := generated(*arguments)))
            return found

        monkeypatch.setattr(compiler(), "generated", noted)
        answer(program)
        return made

    with_passes(passes.NAMES)
    whole = [code(program) for program, _ in SECTIONS[name]]
    with_passes(passes.NAMES - {name})
    assert [code(program) for program, _ in SECTIONS[name]] != whole


# ------------------------------------------------------------------------------------------------------------------- switches


@pytest.mark.parametrize(
    ("text", "on"),
    [
        ("", passes.NAMES),
        ("all", passes.NAMES),
        ("none", set()),
        ("lists", {"lists"}),
        ("lists,slots", {"lists", "slots"}),
        ("lists, slots", {"lists", "slots"}),
        ("-lists", passes.NAMES - {"lists"}),
        ("-lists,-slots", passes.NAMES - {"lists", "slots"}),
        ("all,-lists", passes.NAMES - {"lists"}),
        ("lists,-lists", set()),
    ],
)
def test_a_text_says_which_passes_are_on(text, on):
    assert passes.chosen(text) == on


@pytest.mark.parametrize(("text", "named"), [("lisst", "lisst"), ("-lisst", "lisst"), ("lists,x,-a", "a, x")])
def test_an_unknown_name_is_told_with_the_names_that_there_are(text, named):
    with pytest.raises(passes.UnknownPass) as caught:
        passes.chosen(text)
    assert str(caught.value) == f"CRAMHY_PASSES: unknown pass {named}. The passes are: {', '.join(NAMES)}; all; none."


def stamped(value):
    """(stamp, what went wrong) of another process with that value of CRAMHY_PASSES."""
    code = "from cramhy_runtime.languages.compiler_stamp import stamp; print(stamp())"
    environment = {**os.environ, "CRAMHY_PASSES": value}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    return done.stdout.strip(), done.stderr.strip()


def test_kept_code_of_other_passes_is_not_used():
    usual, others = stamped(""), [stamped("-lists"), stamped("none"), stamped("lists")]
    assert all(stamp for stamp, _ in others)
    assert len({usual, *others}) == 4


def test_a_program_with_an_unknown_pass_is_told_so():
    done = subprocess.run(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl"],
        input="(+ 1 2)",
        capture_output=True,
        text=True,
        env={**os.environ, "CRAMHY_PASSES": "lisst"},
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"cramhy: CRAMHY_PASSES: unknown pass lisst. The passes are: {', '.join(NAMES)}; all; none.\n"
