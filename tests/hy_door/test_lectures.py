"""Each form of both lectures, at a prompt of ``hy`` and piped into it, in Common Lisp and in plain Hy: the answers of ``roslisp_repl``."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from .conftest import HY, REQUIRE, ROOT, Door, environment, stable
from .lectures_in_hy import LECTURES, SLIP, surplus

VARIABLES = {"PYTHONPATH": f"{ROOT / 'src'}:{ROOT / 'hy_src'}", "ROS_PACKAGE_PATH": str(ROOT / "tutorials")}

DIFFERENCES = [
    ("The prompt of Hy does not show a package.", r"[A-Z-]+> \Z", r"=> \Z", "> "),
    (
        "Hy calls a bracket too many an error, and Lisp warns of it.",
        r"STYLE-WARNING: unmatched close .* ignored\n.*\n> \Z",
        r"cramhy: SYNTAX-ERROR\n  There is a \) too many.*\n  at .*\n.*\n +\^\n> \Z",
        "<and a bracket too many>> ",
    ),
    ("Hy shows nothing for None, which is nil.", r"(?:(?<=\n)|\A)NIL\n(?=.*> \Z)", None, ""),
    ("True is t.", None, r"(?:(?<=\n)|\A)True\n(?=.*> \Z)", "T\n"),
    ("setv and defn have no value, and do not tell what they replace.", r"\A(WARNING: redefining \S+ in DEFUN\n)?DEFINED\n", None, ""),
    (
        "Hy shows an error without choices; nothing waits for one.",
        r"\n(?:debugger invoked on a )(.*):\n(?s:(.*?))\n\nrestarts (?s:.*)\n0\] \Z",
        r"cramhy: (.*)\n(?s:(.*))\n> \Z",
        r"<an error> \1\n\2\n> ",
    ),
    ("Hy writes a double as Python does.", r"\b\d+\.\d+d-?\d+\b", None, lambda number: repr(float(number[0].replace("d", "e")))),
    ("Python's random numbers are others.", *2 * [r"\((R|G|B|WIDTH) \d+\)"], r"(\1 <a number>)"),
]
"""(why, in the answer of ``roslisp_repl``, in that of ``hy``, what stands for both): all that differs, but for steps that end otherwise."""


def uniform(answer, in_hy, defined=""):
    """``answer``, to Hy if ``in_hy`` and otherwise to Lisp, without what differs. defined: the name that the form defines."""
    answer = re.sub(r"<stdin>-\d+|<repl>", "<text>", stable(answer))
    for _, lisp, hy, both in DIFFERENCES:
        pattern = hy if in_hy else lisp
        if pattern is not None and ("DEFINED" not in pattern or defined):
            answer = re.sub(pattern.replace("DEFINED", re.escape(defined)), both, answer)
    return answer


def defined_by(form):
    found = re.match(r"\(def(?:un|var) (\S+)", form)
    return found[1].upper() if found else ""


@pytest.fixture(scope="module", params=LECTURES)
def lecture(request, shared):
    """The steps of a lecture, and what three prompts have answered: ``roslisp_repl``, ``hy`` in Lisp, ``hy`` in Hy."""
    if not HY.exists():
        pytest.skip("hy is not installed beside Python")
    steps = LECTURES[request.param](shared / "slides")
    answers = {name: [] for name in ("roslisp_repl", "lisp", "hy")}
    with (
        Door("repl", "--time", "virtual") as roslisp,
        Door(program=[str(HY)], variables=VARIABLES) as lisp,
        Door(program=[str(HY)], variables=VARIABLES) as hy,
    ):
        roslisp.expect("> $")
        lisp.begin_lisp()
        hy.begin_hy()
        for step in steps:
            for name, door in (("roslisp_repl", roslisp), ("lisp", lisp)):
                answers[name].append(step.lisp and stable(door.ask(step.lisp)))
                if step.lisp and answers[name][-1].endswith("] "):
                    assert re.fullmatch(r"[A-Z-]+> ", door.ask(":abort"))
            answers["hy"].append(step.hy and hy.ask(step.hy))
    return steps, answers


def test_common_lisp_at_the_prompt_of_hy_is_answered_as_by_roslisp_repl(lecture):
    steps, answers = lecture
    for step, answer, expected in zip(steps, answers["lisp"], answers["roslisp_repl"]):
        assert answer == expected, step.lisp


def test_plain_hy_at_the_prompt_of_hy_is_answered_as_lisp_is_by_roslisp_repl(lecture):
    steps, answers = lecture
    for step, answer, expected in zip(steps, answers["hy"], answers["roslisp_repl"]):
        if step.ends is not None:
            assert answer.endswith(step.ends), step.hy
        elif step.lisp is None or (step.hy or "").startswith("(lisp-package "):  # Hy shows nothing of Lisp's packages
            assert answer == "=> ", step.hy
        elif (step.hy or "").startswith(SLIP):
            assert uniform(answer, in_hy=True) == "<and a bracket too many>> "
        elif step.hy is not None:
            assert uniform(answer, in_hy=True) == uniform(expected, in_hy=False, defined=defined_by(step.lisp)), step.hy


def test_nothing_of_the_lectures_is_left_out(shared):
    """All forms of the slides' files, and all that the tables say is typed at the prompt, are steps, and all but systems are in Hy."""
    steps = [step for lecture in LECTURES.values() for step in lecture(shared / "slides")]
    typed = [step.lisp for step in steps if step.lisp is not None]
    together = " ".join(" ".join(form.split()) for form in typed)
    files = [*(shared / "slides").rglob("*.lisp"), *(shared / "slides").rglob("*.asd")]
    assert len(files) > 15
    for path in files:
        for form in re.split(r"\n(?=\()", path.read_text().strip()):
            assert " ".join(form.split()) in together, path
    rows = re.findall(r"^\| \d+ \| [^|]*REPL \| (.*?) \| ", (shared / "slides" / "README.md").read_text(), re.M)
    named = [form for row in rows for form in re.findall(r"`(\(.*?\))`", row)]
    assert len(named) > 8 and set(named) <= set(typed)
    assert all(step.lisp.startswith(("(defsystem", "(in-package :asdf-user)")) for step in steps if step.hy is None)


# ------------------------------------------------------------------------------------------------------------------- pipes


def piped(words, text, folder):
    """What a program with a text piped into it prints, its errors among it."""
    done = subprocess.run(
        words,
        input=text,
        cwd=folder,
        env=environment(CRAMHY_TIME="virtual", PYTHONUNBUFFERED="1", **VARIABLES),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout
    return alike(done.stdout)


def alike(text):
    """``text`` without what is another one each time, and without the folder that paths are shown in or not."""
    text = re.sub(r"<stdin>-\d+", "<stdin>", stable(text)).replace(f"{ROOT}/", "")
    return re.sub(*DIFFERENCES[-1][2:], text)


@pytest.mark.soak
def test_common_lisp_that_is_piped_into_hy_is_answered_as_by_roslisp_repl(lecture, tmp_path, roslisp):
    steps, answers = lecture
    lines = []
    for step, answer in zip(steps, answers["roslisp_repl"]):
        lines += [step.lisp] if step.lisp else []
        lines += [":abort"] if step.lisp and answer.endswith("] ") else []
    text = "\n".join(lines) + "\n"
    answered = piped([str(HY)], f"{REQUIRE}\n(in-package :cl-user)\n{text}", tmp_path)
    assert answered == alike('CL-USER> #<PACKAGE "COMMON-LISP-USER">\n' + roslisp(text).stdout)


@pytest.mark.soak
def test_plain_hy_that_is_piped_into_a_prompt_of_hy_is_answered_as_if_it_was_typed(lecture, tmp_path):
    steps, answers = lecture
    typed = [(step.hy, answer) for step, answer in zip(steps, answers["hy"]) if step.hy is not None]
    answered = piped([str(HY), "-i"], "\n".join([REQUIRE, *(text for text, _ in typed)]) + "\n", tmp_path)
    expected = "".join("... " * text.count("\n") + alike(answer) for text, answer in typed)
    assert answered.split("=> ", 2)[2] == f"{expected}\nnow exiting REPL...\n"


@pytest.mark.soak
def test_plain_hy_that_is_piped_into_hy_prints_what_the_plans_print(lecture, tmp_path):
    """``hy < FILE`` shows no values, so ``roslisp_repl`` is asked for none. An error would end the text, so there is none in it.

    ``defpackage`` is left away, too: it runs when a text is compiled and when it runs, and tells twice that another package is there.
    """
    steps, answers = lecture
    in_lisp, in_hy = [], []
    for step, answer in zip(steps, answers["roslisp_repl"]):
        fails = step.ends is not None or (answer or "").endswith("] ")
        if step.hy is None or fails or step.hy.startswith("(defpackage"):
            continue
        too_many = surplus(step.lisp or "")
        in_hy.append(step.hy.removesuffix(too_many))
        if step.lisp is not None:
            in_lisp.append(f"(progn {step.lisp.removesuffix(too_many)} (values))")
    printed = piped([str(HY)], "\n".join([REQUIRE, *in_hy]) + "\n", tmp_path)
    answered = piped([sys.executable, "-m", "cramhy_runtime.cli", "repl"], "\n".join(in_lisp) + "\n", tmp_path)
    answered = re.sub(r"^(?:[A-Z-]+> )+", "", answered, flags=re.M)
    answered = re.sub(r"^; No value\n|^WARNING: redefining .* in DEFUN\n", "", answered, flags=re.M)
    line = r"<(?:repl|stdin)>:\d+:"  # the text is one in Hy, and many in Lisp
    assert re.sub(line, "<text>:", printed) == re.sub(line, "<text>:", answered)
