"""What Python and Hy print, and what they ask, goes to the Emacs whose request it is."""

from __future__ import annotations

import sys
import threading

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.swank import streams

from .client import Emacs

PRINTED = {
    "print": "(py:print 1)",
    "sys.stdout": "(py:exec \"import sys; sys.stdout.write('1' + chr(10))\")",
    "several lines": "(py:exec \"import sys; sys.stdout.writelines(['1', chr(10)])\")",
    "sys.stderr": "(py:exec \"import sys; sys.stderr.write('1' + chr(10))\")",
    "bytes": '(py:exec "import sys; sys.stdout.buffer.write(bytes([49, 10]))")',
    "print to a file": '(py:exec "import sys; print(1, file=sys.stderr)")',
    "in a branch of a plan": "(cpl:top-level (cpl:par (py:print 1)))",
}
ASKED = {
    "input": '(py:input "what? ")',
    "readline": "(py:eval \"__import__('sys').stdin.readline().rstrip()\")",
    "in a branch of a plan": '(cpl:top-level (cpl:par (py:input "what? ")))',
}


@pytest.mark.parametrize("way", PRINTED)
def test_what_python_prints_reaches_emacs(capsys, session, way):
    emacs = Emacs(session)  # here, since pytest sets its own files before it calls a test
    assert "1\n" in emacs.repl(PRINTED[way])
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("way", ASKED)
def test_what_python_asks_is_asked_in_emacs(capsys, session, way):
    emacs = Emacs(session)
    number = emacs.rex(f"(swank-repl:listener-eval {lisp(ASKED[way])})", thread=":repl-thread")
    _, thread, tag = emacs.wait_for(":read-string")
    emacs.post(f'(:emacs-return-string {thread} {tag} "this\n")')
    assert emacs.wait(number)[0] == ":ok"
    assert '"this"' in "".join(event[1] for event in emacs.events if event[0] == ":write-string")
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    "form", ['(swank:eval-and-grab-output "(progn (py:print 1) 2)")', '(swank:eval-and-grab-output "(progn (princ 1) (terpri) 2)")']
)
def test_a_key_that_collects_what_a_form_prints_collects_what_python_prints(session, form):
    assert Emacs(session).call(form) == ["1\n", "2"]


def test_lisp_collects_what_python_prints_in_a_form_of_emacs(session):
    assert Emacs(session).repl("(length (with-output-to-string (*standard-output*) (py:print 123)))") == "4\n"


def lisp(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def test_each_emacs_gets_what_its_own_requests_print(session):
    one = Emacs(session)
    other = Emacs(session, one.server)
    assert "1\n" in one.repl("(py:print 1)") and "2\n" in other.repl("(py:print 2)")
    assert "2" not in "".join(event[1] for event in one.events if event[0] == ":write-string")


def test_beside_a_prompt_what_nobody_has_asked_for_goes_where_it_went(capsys, session):
    emacs = Emacs(session)
    streams.route_no_more(emacs.server)
    streams.route(emacs.server, alone=False)
    session.evaluate_text("(py:print 1)")
    thread = threading.Thread(target=print, args=(2,))
    thread.start()
    kernel.run_blocking(thread.join)
    assert capsys.readouterr().out == "1\n2\n"


def test_the_files_pass_for_those_that_they_stand_for(session):
    before = sys.stdin, sys.stdout
    Emacs(session)
    assert isinstance(sys.stdin, type(before[0])) and isinstance(sys.stdout, type(before[1]))
    assert (sys.stdout.encoding, sys.stdout.isatty()) == (before[1].encoding, before[1].isatty())


def test_the_end_of_the_server_gives_the_files_back(session):
    before = sys.stdin, sys.stdout, sys.stderr
    emacs = Emacs(session)
    assert all(streams.is_routed(file) for file in (sys.stdin, sys.stdout, sys.stderr))
    streams.route(emacs.server, alone=True)
    streams.route_no_more(emacs.server)
    assert (sys.stdin, sys.stdout, sys.stderr) == before
