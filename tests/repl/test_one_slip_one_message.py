"""A slip of the hand, such as one parenthesis too many, gets one message that leads to it, and not one for each of its consequences."""

from __future__ import annotations

import re

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools.error_reports import report
from cramhy_runtime.repl.session import Session, condition_of


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    yield made
    kernel.stop()


@pytest.fixture
def said(session, monkeypatch, tmp_path, capsys):
    """What loading a file with a text says, without what the text prints."""
    monkeypatch.chdir(tmp_path)

    def said(text):
        output = streams.StringOutputStream()
        monkeypatch.setattr(streams.ERROR_OUTPUT, "value", output)
        (tmp_path / "plan.lisp").write_text(text)
        try:
            session.load("plan.lisp")
        except (Condition, Exception) as problem:
            report(condition_of(problem))
        said.printed, errors = capsys.readouterr()
        return re.sub("WARNING: redefining .*\n", "", output.take() + errors)  # by the test before it

    return said


MESSAGE = re.compile(r"^(; caught|STYLE-WARNING|WARNING|cramhy:)", re.M)


def messages(text):
    return len(MESSAGE.findall(text))


class TestUnmatchedCloses:
    def test_several_in_a_row_are_one_message(self, said):
        assert said("(print 1)))) ; four\n  ) \n(print 2)") == (
            "STYLE-WARNING: unmatched close parenthesis at plan.lisp:1:10, ignored\n"
            "  There are 4 ) too many here, or 4 ( are missing before it.\n"
        )
        assert said.printed == "\n1 \n2 "

    def test_forms_that_were_cut_off_by_one_are_left_out_with_the_form_that_it_cut(self, said):
        text = "(print 0)\n(defun cut (x)\n  (print x))\n  (print :one)\n  ; more\n  (list x\n    (print :two)))\n(print 3)"
        assert said(text) == (
            "WARNING: unmatched close parenthesis at plan.lisp:7:18, lines 2 to 7 left out\n"
            "  The form of line 2 ends at line 3, column 12, but the lines behind it are indented as if they were inside. There is one ) "
            "too many up to line 3, column 12, or a ( is missing.\n"
        )
        assert said.printed == "\n0 \n3 "

    def test_it_is_told_each_time_that_the_file_is_loaded(self, said):
        text = "(progn (print 0))\n  (print 1))\n"
        assert said(text) == said(text) != ""

    @pytest.mark.parametrize(
        ("text", "printed"),
        [
            ("(print 1)\n  (print 2)\n(print 3)", "\n1 \n2 \n3 "),  # indented, and all is well
            ("(print 1) (print 2))\n(print 3)", "\n1 \n2 \n3 "),  # on one line nobody knows which one was cut
            ("  (print 1)\n  (print 2))\n  (print 3)", "\n1 \n2 \n3 "),  # no more indented than the form before
            ('(print 1)\n  (princ "\n)))")\n(print 3)', "\n1 \n)))\n3 "),
            ("(print 1)\n  #| ) |#\n  (print #\\))\n(print 3)", "\n1 \n#\\) \n3 "),
        ],
    )
    def test_forms_that_may_stand_where_they_are_run(self, said, text, printed):
        said(text)
        assert said.printed == printed

    def test_what_the_compiler_finds_in_such_a_form_may_come_of_it(self, said):
        text = said("(defun sum (a b)\n  (let (c)\n    (list a d e))))\n(defun good (x) 1)")
        assert messages(text) == 2 and "plan.lisp:3:19, ignored" in text and "The variable X is defined but never used." in text

    def test_too_many_are_an_error(self, said):
        assert said("(print 1)\n" + ")" * 100) == (
            "cramhy: SB-INT:SIMPLE-READER-ERROR\n  unmatched close parenthesis\n  at plan.lisp:2:1\n"
            f"  {')' * 100}\n  ^\n  There is one ) too many, or a ( is missing before it.\n"
        )


class TestUnknownNames:
    def test_an_unknown_variable_is_told_once_with_its_places(self, said):
        assert said("(defun a () (list goal\n  (list goal goal)))\n(defun b ()\n  goal)") == (
            "; caught WARNING:\n;   undefined variable: COMMON-LISP-USER::GOAL\n;   at plan.lisp:1:19\n"
            ";     (defun a () (list goal\n;                       ^\n;   also at plan.lisp:2:9, plan.lisp:4:3\n"
        )

    def test_what_is_unknown_in_the_form_of_an_unknown_macro_is_not_told(self, said):
        text = (
            "(defun facts ()\n  (def-rules animals (legs ?n)\n    (<- (legs dog) 4)\n    (<- (legs ?bird) two)))\n(defun other () unknown)"
        )
        text = said(text)
        assert re.findall("undefined (.*)", text) == ["function: COMMON-LISP-USER::DEF-RULES", "variable: COMMON-LISP-USER::UNKNOWN"]

    def test_in_a_call_of_an_unknown_function_a_single_one_is_told(self, said):
        text = said("(defun a () (driive 1 fast))")
        assert [name.rpartition(":")[2] for name in re.findall("undefined (.*)", text)] == ["DRIIVE", "FAST"]

    def test_a_form_that_fails_has_one_message(self, said):
        """The error tells, and not the compiler once more."""
        text = said("(defun fine (x) 1)\n(def-rules animals (legs ?n)\n  (<- (legs dog) 4))")
        assert messages(text) == 2 and "The variable X is defined but never used." in text
        assert "cramhy: UNBOUND-VARIABLE\n  The variable ANIMALS is unbound.\n" in text and "(def-rules ...) is taken for a call" in text

    def test_names_that_packages_of_sbcl_have_too_are_told_of_as_those_of_the_plan_language(self, said):
        said("(sb-ext:gc)")  # makes the package
        text = said("(defun plan (f)\n  (top-level (seq (wait-for f)\n    (pursue (fl-funcall f)))))")
        assert "cpl:wait-for" in text and "sb-ext" not in text

    def test_a_text_in_the_wrong_package_is_told_once(self, said):
        text = said("(defun plan (f)\n  (top-level (seq (wait-for f)\n    (pursue (fl-funcall f)))))")
        assert text == (
            "; caught STYLE-WARNING:\n;   undefined functions in the package COMMON-LISP-USER:\n"
            ";   TOP-LEVEL, SEQ, WAIT-FOR, PURSUE, FL-FUNCALL\n;   at plan.lisp:2:3\n"
            ";       (top-level (seq (wait-for f)\n;       ^\n"
            ";   Other packages have them: cpl:top-level, cpl:seq, cpl:wait-for ... Is the form (in-package ...) missing above them?\n"
        )

    def test_a_scope_that_ends_too_early(self, said):
        assert said("(defun a ()\n  (let ((b 2) (c 3)))\n    (list b\n      (list c b)))") == (
            "; caught WARNING:\n;   undefined variable: COMMON-LISP-USER::B\n;   at plan.lisp:3:11\n;         (list b\n;               ^\n"
            ";   also at plan.lisp:4:15\n;   It is bound at line 2, column 10, where nothing uses it: the scope of that ends before line 3. "
            "Look at the parentheses in between.\n"
        )


PLAN = """\
(defvar *speed* 5)

(defun steer (goal &key (speed *speed*) turns)
  (let ((distance (abs goal))
        (angle (/ goal 2)))
    (cond ((> distance 10) (list :far speed))
          ((eql turns 0) (list :here angle)))
    (dolist (turn (list 1 2 3))
      (setf angle (+ angle turn)))
    (list distance angle)))

(defun drive (goals)
  (destructuring-bind (first second) goals
    (flet ((near (a b) (< (abs (- a b)) 2)))
      (when (near first second)
        (steer first :turns 2)))))

(drive (list 3 4))
"""


@pytest.mark.soak
def test_whatever_parenthesis_is_missing_or_too_many_there_are_few_messages(said):
    counts = []
    for place in (found.start() for found in re.finditer(r"[()]", PLAN)):
        for broken in (PLAN[:place] + PLAN[place + 1 :], f"{PLAN[:place]}({PLAN[place:]}", f"{PLAN[:place]}){PLAN[place:]}"):
            counts.append(messages(said(broken)))
    assert max(counts) <= 2
    assert sum(count <= 1 for count in counts) >= 0.75 * len(counts)
