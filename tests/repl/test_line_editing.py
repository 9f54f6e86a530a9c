"""What an editor of lines does at the prompt: prompts that say what is open, TAB in strings, a history of forms; and nothing where it cannot."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys

import pytest

pytest.importorskip("termios", reason="a pseudo-terminal needs termios, which this system lacks")

from cramhy_runtime.kernel.terminals import draws  # noqa: E402
from cramhy_runtime.repl import banner  # noqa: E402
from cramhy_runtime.repl.file_names import begun_string, file_names  # noqa: E402
from cramhy_runtime.repl.history import History  # noqa: E402
from cramhy_runtime.repl.open_forms import Pairs  # noqa: E402
from cramhy_runtime.repl.readline_lines import Tab, in_string  # noqa: E402

from .conftest import environment  # noqa: E402
from .terminal import Terminal  # noqa: E402

UP = "\x1b[A"
XTERM = {"TERM": "xterm"}


@pytest.fixture(params=["prompt_toolkit", "readline"])
def prompt(request):
    """``prompt()``: a `Terminal` with a prompt of Lisp that one of the two editors edits."""
    pytest.importorskip(request.param)

    def prompt(**variables):
        return Terminal("repl", "--time", "virtual", editor=request.param == "prompt_toolkit", variables={**XTERM, **variables})

    return prompt


@pytest.mark.soak
def test_the_prompt_of_a_line_that_goes_on_says_what_is_open(prompt):
    with prompt() as terminal:
        terminal.expect("CL-USER> ")
        terminal.type("(list 1")
        terminal.expect("list 1> ")
        terminal.type("  (length")
        terminal.expect("length 2> ")
        terminal.type('"three')
        terminal.expect('" 2> ')
        terminal.type('" #| four')
        terminal.expect(r"#\| 2> ")
        terminal.type("|# ))")
        terminal.expect(r"\(1 6\)")
        terminal.expect("CL-USER> ")
        terminal.type("(list 5")
        terminal.expect("list 1> ")
        terminal.control_c()
        terminal.expect("CL-USER> ")
        terminal.type("(+ 3 3)")
        terminal.expect(r"\n6\n")
        terminal.expect("CL-USER> ")
        assert terminal.end() == 0


@pytest.mark.soak
def test_a_form_of_several_lines_is_one_entry_which_the_next_session_has_too(prompt, tmp_path):
    form = "(list 'once\n  'upon)"
    with prompt(CRAMHY_HISTORY=str(tmp_path)) as terminal:
        terminal.expect("CL-USER> ")
        for line in form.split("\n"):
            terminal.type(line)
        terminal.expect(r"\(ONCE UPON\)")
        terminal.expect("CL-USER> ")
        terminal.press("(forgotten")
        terminal.control_c()
        terminal.expect("CL-USER> ")
        terminal.press(UP)
        terminal.expect("'upon")
        terminal.type("")
        terminal.expect(r"\(ONCE UPON\)")
        terminal.expect("CL-USER> ")
        terminal.type("(+ 4 4)")
        terminal.expect(r"\n8\n")
        terminal.expect("CL-USER> ")
        assert terminal.end() == 0
    assert History(str(tmp_path / "lisp-history")).forms == [form, "(+ 4 4)"]
    with prompt(CRAMHY_HISTORY=str(tmp_path)) as terminal:
        terminal.expect("CL-USER> ")
        terminal.press(UP + UP)
        terminal.expect("'upon")
        terminal.type("")
        terminal.expect(r"\(ONCE UPON\)")


def test_help_tells_of_the_keys(prompt):
    with prompt() as terminal:
        terminal.expect("CL-USER> ")
        terminal.type("help")
        terminal.expect("TAB +completes names, keywords and files; arrow keys bring back earlier forms")


def test_tab_completes_the_name_of_a_file_in_a_string(prompt, tmp_path):
    (tmp_path / "my only plan.lisp").write_text("")
    with prompt() as terminal:
        terminal.expect("CL-USER> ")
        terminal.press(f'(file-namestring "{tmp_path}/my on\t')
        terminal.expect(r"plan\.lisp")
        terminal.type('")')
        terminal.expect('\n"my only plan.lisp"\n')


@pytest.mark.soak
def test_tab_as_the_first_key_knows_the_names_of_all_rooms(prompt):
    """A prompt without options begins with Common Lisp alone."""
    with prompt() as terminal:
        terminal.expect("CL-USER> ")
        terminal.press("(cpl:make-flu\t")
        terminal.expect("make-fluent")
        terminal.type(" :value 17)")
        terminal.expect(r"#<FLUENT FLUENT-1 \[17\]>")


@pytest.mark.soak
def test_hy_says_what_is_open_and_keeps_forms_in_a_file_of_ours_alone(tmp_path):
    pytest.importorskip("readline")
    history = tmp_path / "hy"
    history.write_text("(old 1)\n")
    variables = {**XTERM, "CRAMHY_HISTORY": str(tmp_path), "HY_HISTORY": str(history)}
    with Terminal("repl", "--hy", variables=variables) as terminal:
        terminal.expect("=> ")
        terminal.type('(.join "-" ["a"')
        terminal.expect(r"\[ 2> ")
        terminal.type('"b')
        terminal.expect('" 2> ')
        terminal.type('c"])')
        terminal.expect(r'"a-b\\nc"')
        terminal.expect("=> ")
        terminal.type("(in-package :cl-user)")
        terminal.expect("CL-USER> ")
        terminal.type("(list #| a")
        terminal.expect(r"#\| 1> ")
        terminal.type("|# 1)")
        terminal.expect(r"\(1\)")
        terminal.expect("CL-USER> ")
        terminal.press(UP)
        terminal.expect(r"\|# 1\)")
        terminal.control_c()
        terminal.expect("CL-USER> ")
        terminal.end()
    assert History(str(tmp_path / "hy-history")).forms == ['(.join "-" ["a"\n"b\nc"])', "(in-package :cl-user)", "(list #| a\n|# 1)"]
    assert "old" in history.read_text() and "join" not in history.read_text()


# ------------------------------------------------------------------------------------------------- a terminal that cannot draw


@pytest.mark.soak
@pytest.mark.parametrize("arguments", [["repl"], ["repl", "--hy"]], ids=["lisp", "hy"])
def test_on_a_dumb_terminal_nothing_is_echoed_and_no_escape_sequence_is_written(arguments, tmp_path):
    """Emacs switches the echo of the terminal off, and shows what is typed itself."""
    import termios

    variables = {"TERM": "dumb", "CRAMHY_HISTORY": str(tmp_path)}
    with Terminal(*arguments, variables=variables, wrapped=True, program=[sys.executable, "-m", "cramhy_runtime.cli"]) as terminal:
        modes = termios.tcgetattr(terminal.slave)
        modes[3] &= ~termios.ECHO
        termios.tcsetattr(terminal.slave, termios.TCSANOW, modes)
        terminal.begin()
        terminal.expect("> ")
        terminal.type("(+ 20")
        terminal.type("22)")
        terminal.expect("42\n")
        terminal.expect("> ")
        assert "20" not in terminal.text and "22" not in terminal.text
        assert b"\x1b" not in terminal.raw
        terminal.control_c()
        terminal.expect("> ")
        assert terminal.end() == 0
        assert b"\x1b" not in terminal.raw
    if arguments == ["repl"]:
        assert os.listdir(tmp_path) == []


EMACS = """
(require 'inf-lisp)
(setq program (car command-line-args-left) command-line-args-left nil)
(run-lisp program)
(set-buffer "*inferior-lisp*")
(defun prompts (count)
  (let ((end (+ (float-time) 60)))
    (while (and (< (float-time) end)
                (not (save-excursion (goto-char (point-min)) (re-search-forward "^\\\\(CL-USER> \\\\|0\\\\] \\\\)" nil t count))))
      (accept-process-output (get-buffer-process (current-buffer)) 0.1))))
(defun enter (text count)
  (goto-char (point-max)) (insert text) (comint-send-input) (prompts count))
(prompts 1)
(enter "(list 1\\n  \\"two\\")" 2)
(enter "(car 5)" 3)
(enter "abort" 4)
(with-temp-buffer
  (insert "(defun twice (x)\\n  ;; a comment (\\n  (* 2\\n     x))") (lisp-mode)
  (lisp-eval-region (point-min) (point-max)))
(prompts 5)
(enter "(twice 21)" 6)
(princ (buffer-substring-no-properties (point-min) (point-max)))
(set-process-query-on-exit-flag (get-buffer-process (current-buffer)) nil)
"""


@pytest.mark.soak
def test_run_lisp_of_emacs_shows_what_was_typed_once_and_the_answers(tmp_path):
    emacs = shutil.which("emacs")
    if emacs is None:
        pytest.skip("emacs is not installed")
    (tmp_path / "drive.el").write_text(EMACS)
    (tmp_path / "lisp").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m cramhy_runtime.cli repl\n')
    (tmp_path / "lisp").chmod(0o755)
    done = subprocess.run(
        [emacs, "--batch", "-Q", "-l", str(tmp_path / "drive.el"), str(tmp_path / "lisp")],
        env={**environment(), "HOME": str(tmp_path)},
        text=True,
        capture_output=True,
        timeout=200,
    )
    shown = re.sub(r"(?s)\ndebugger invoked.*?top level\.\n", "<debugger>\n", done.stdout)
    assert shown == (
        f"{banner.of_lisp()}\n"
        'CL-USER> (list 1\n  "two")\n(1 "two")\nCL-USER> (car 5)\n<debugger>\n0] abort\nCL-USER> TWICE\nCL-USER> (twice 21)\n42\nCL-USER> '
    ), done.stderr


def test_what_draws(monkeypatch):
    class File:
        def __init__(self, terminal):
            self.isatty = lambda: terminal

    for term, expected in (("xterm", True), ("dumb", False), ("", False), ("unknown", False), ("emacs", False)):
        monkeypatch.setenv("TERM", term)
        assert draws(File(True)) is expected, term
        assert draws(File(False)) is False
    assert draws(None) is False


# --------------------------------------------------------------------------------------------------------------- files, pairs


def test_names_of_files_are_offered_as_they_are_written_in_a_string(tmp_path):
    for name in ("plan.lisp", "plan two.lisp", 'a"b', "c\\d", ".hidden", "bad\nname"):
        (tmp_path / name).write_text("")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "deep.hy").write_text("")
    folder = f"{tmp_path}/"
    assert file_names("pla", folder) == ["plan two.lisp", "plan.lisp"]
    assert file_names("", folder) == ['a\\"b', "c\\\\d", "plan two.lisp", "plan.lisp", "sub/"]
    assert file_names(".", folder) == [".hidden"]
    assert file_names("sub/", folder) == ["sub/deep.hy"]
    assert file_names('a\\"', folder) == ['a\\"b']
    assert file_names(f"{tmp_path}/su", "/") == [f"{tmp_path}/sub/"]
    assert file_names("nowhere/x", folder) == file_names("plan.lisp/x", folder) == file_names("\0", folder) == []


def test_a_tilde_is_the_home_of_the_user(tmp_path, monkeypatch):
    (tmp_path / "plan.lisp").write_text("")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert file_names("~/pl", "/") == ["~/plan.lisp"]


@pytest.mark.parametrize(
    "text, typed",
    [
        ('(load "', ""),
        ('(load "a b', "a b"),
        ('(load "a"', None),
        ('(list #\\" "x', "x"),
        ('; "x', None),
        ("(load", None),
        ('(a "x" "y\\"z', 'y\\"z'),
    ],
)
def test_what_is_typed_of_a_string(text, typed):
    assert begun_string(text) == typed


def test_readline_gets_what_its_word_becomes(tmp_path):
    (tmp_path / "my plan.lisp").write_text("")
    assert in_string('(load "my', '"my', folder=str(tmp_path)) == ['"my plan.lisp']
    assert in_string('(load "my pl', "pl", folder=str(tmp_path)) == ["plan.lisp"]
    assert in_string('(load #p"my', '#p"my', folder=str(tmp_path)) == ['#p"my plan.lisp']
    assert in_string("(load my", "my") is None
    assert Tab().found('(load "ca', '"ca') == []


def test_the_pairs_of_a_text():
    def pairs(text, hy=False):
        found = Pairs(hy)
        found.read(text)
        return found.partner

    assert pairs("(a (b) c)") == {0: 8, 8: 0, 3: 5, 5: 3}
    assert pairs('(a "(" #\\( ; (\n)') == {0: 15, 15: 0}
    assert pairs("(a") == {}
    assert pairs("a)") == {}
    assert pairs("[a]", hy=True) == {0: 2, 2: 0}


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("cursor, marked", [(0, {0, 8}), (9, {0, 8}), (6, {3, 5}), (5, {3, 5}), (2, set())])
def test_the_parenthesis_at_the_cursor_and_its_partner_are_marked(cursor, marked):
    pytest.importorskip("prompt_toolkit")
    from prompt_toolkit.document import Document
    from prompt_toolkit.layout.processors import TransformationInput

    from cramhy_runtime.repl.edited_lines import Partners

    text = "(a (b) c)"
    shown = Partners().apply_transformation(TransformationInput(None, Document(text, cursor), 0, lambda index: index, [("", text)], 80, 24))
    places = {index for index, fragment in enumerate(shown.fragments) if "matching-bracket" in fragment[0]}
    assert places == marked
    assert "".join(fragment[1] for fragment in shown.fragments) == text
