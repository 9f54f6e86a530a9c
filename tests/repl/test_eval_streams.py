"""``cramhy eval`` writes answers to standard output and nothing else: what forms print, in whatever way, stands in their answers."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest
from systems import posix

WAYS = {
    "Lisp": ("(princ 1)", "1"),
    "Lisp's errors": ("(princ 1 *error-output*)", "1"),
    "Lisp's terminal": ("(princ 1 *terminal-io*)", "1"),
    "Lisp's questions": ('(format *query-io* "1~%")', "1\n"),
    "Lisp's trace": ("(princ 1 *trace-output*)", "1"),
    "print": ("(py:print 1)", "1\n"),
    "Python's stdout": ("(py:eval \"__import__('sys').stdout.write('1')\")", "1"),
    "Python's stderr": ("(py:eval \"__import__('sys').stderr.write('1')\")", "1"),
    "bytes": ("(py:eval \"__import__('sys').stdout.buffer.write(b'1')\")", "1"),
    "a warning": ("(py:eval \"__import__('warnings').warn_explicit('1', UserWarning, 'x.py', 7)\")", "x.py:7: UserWarning: 1\n"),
    "the descriptor": ("(py:eval \"__import__('os').write(1, b'1')\")", "1"),
    "the descriptor of errors": ("(py:eval \"__import__('os').write(2, b'1')\")", "1"),
    "os.system": ('(py:call "os.system" "echo 1")', "1\n"),
    "the errors of os.system": ('(py:call "os.system" "echo 1 1>&2")', "1\n"),
    "subprocess": ('(py:call "subprocess.run" (py:list (list "echo" "1")))', "1\n"),
    "subprocess into sys.stdout": ("(py:exec \"import subprocess, sys; subprocess.run(['echo', '1'], stdout=sys.stdout)\")", "1\n"),
    "signs that are not ASCII": ('(py:call "os.system" "echo ü→")', "ü→\n"),
    "bytes that are no text": ("(py:eval \"__import__('os').write(1, bytes([255]))\")", "\ufffd"),
    "all in their order": (
        '(progn (princ 1) (py:print 2) (py:call "os.system" "echo 3; echo 4 1>&2") (princ 5) (py:call "os.system" "printf 6") (fresh-line)'
        " (princ 7))",
        "12\n3\n4\n56\n7",
    ),
}
READS = {
    "(read-line)": "END-OF-FILE",
    "(y-or-n-p)": "END-OF-FILE",
    "(py:input)": "PYTHON::EOF-ERROR",
    "(py:eval \"__import__('sys').stdin.readline()\")": '""',
    "(py:eval \"__import__('sys').stdin.buffer.read()\")": "#()",
    '(py:call "os.system" "cat")': "0",
    "(py:eval \"__import__('os').read(0, 10)\")": "#()",
}


def ran(folder, *requests, words=()):
    """(the lines of standard output, standard error, status) of a process with these requests."""
    words = [sys.executable, "-m", "cramhy_runtime.cli", "eval", "--no-turtlesim", *words]
    lines = "".join(json.dumps({"form": form}) + "\n" for form in requests)
    done = subprocess.run(words, input=lines, capture_output=True, encoding="utf-8", cwd=folder, timeout=120, env={**os.environ})
    return [json.loads(line) for line in done.stdout.splitlines()], done.stderr, done.returncode


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    """The answers of one process to all forms above."""
    forms = [*(form for form, _ in WAYS.values()), *READS]
    found, errors, status = ran(tmp_path_factory.mktemp("eval"), *forms)
    assert errors == "" and status == 0
    return dict(zip(forms, found, strict=True))


@posix
@pytest.mark.parametrize("way", WAYS)
def test_what_is_printed_stands_in_the_answer(answers, way):
    form, printed = WAYS[way]
    assert answers[form]["error"] is None and answers[form]["output"] == printed


@posix
@pytest.mark.parametrize("form", READS)
def test_forms_read_nothing_of_the_requests(answers, form):
    answer = answers[form]
    assert answer["error"]["type"] == READS[form] if answer["error"] else READS[form] in answer["values"][0]


@pytest.mark.soak
@posix
def test_a_child_that_lives_on_writes_into_the_next_answer(tmp_path):
    found, errors, _ = ran(
        tmp_path,
        "(defvar *child* (py:eval \"__import__('subprocess').Popen('read x; echo late', shell=True, stdin=-1)\"))",
        "(princ 1)",
        '(progn (py:call (py:getattr *child* "communicate") (py:call "builtins.bytes" (py:list (list 10)))) (princ 2))',
    )
    assert [answer["output"] for answer in found] == ["", "1", "late\n2"] and errors == ""


@pytest.mark.soak(all_but=1)
@posix
@pytest.mark.parametrize(("form", "status"), [("(exit :code 3)", 3), ("(quit)", 0), ('(py:call "sys.exit" 4)', 4)])
def test_a_form_that_ends_the_program_is_answered_before(tmp_path, form, status):
    found, errors, ended = ran(tmp_path, f'(progn (princ 1) (py:call "os.system" "echo 2") {form})', "(princ 3)")
    assert found == [{"output": "12\n", "values": [], "error": None}] and errors == "" and ended == status


@pytest.mark.soak
@posix
def test_what_is_printed_before_and_after_the_forms_is_no_answer(tmp_path):
    before = '(progn (princ 1) (py:print 2) (py:call "os.system" "echo 3"))'
    cleanup = '(unwind-protect (progn (princ 4) (exit)) (py:call "os.system" "echo 5"))'
    found, errors, _ = ran(tmp_path, cleanup, words=("--eval", before))
    assert [answer["output"] for answer in found] == ["45\n"] and errors == "12\n3\n"
