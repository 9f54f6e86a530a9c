"""The calls that led to an error are shown when ``--backtrace`` asks for them, and otherwise not."""

import pytest

PLAN = """\
(defun wheel-speed (x)
  (car x))

(defun drive (x)
  (list (funcall (lambda (y)
                   (wheel-speed y)) (+ x 1))))

(drive 5)
"""

ERROR = """\
cramhy: TYPE-ERROR
  The value
    6
  is not of type
    LIST
  when binding LIST
  at plan.lisp:2:3
      (car x))
      ^
"""

CALLS = """\

calls, the innermost last:
  the form at plan.lisp:8:1
  DRIVE at plan.lisp:5:9
  (LAMBDA ...) at plan.lisp:6:20
  WHEEL-SPEED at plan.lisp:2:3
"""


@pytest.fixture
def plan(tmp_path):
    (tmp_path / "plan.lisp").write_text(PLAN)


@pytest.mark.soak
@pytest.mark.parametrize(("options", "text"), [((), ERROR), (("--backtrace", "none"), ERROR), (("--backtrace", "lisp"), ERROR + CALLS)])
def test_lisp_calls_are_shown_when_they_are_asked_for(cramhy, plan, options, text):
    assert cramhy("run", "plan.lisp", "--time", "virtual", *options).stderr == text


@pytest.mark.soak
def test_python_frames_are_shown_when_they_are_asked_for(cramhy, plan):
    shown = cramhy("run", "plan.lisp", "--time", "virtual", "--backtrace", "python").stderr
    assert shown.startswith(ERROR + "\nPython frames:\n  File ")
    assert 'plan.lisp", line 2, in wheel_speed\n' in shown and "Traceback" not in shown


def test_the_debugger_shows_them_too(cramhy, plan):
    said = cramhy("repl", "--time", "virtual", "--backtrace", "lisp", input='(load "plan.lisp")\n').stdout
    assert CALLS.replace("last:\n", "last:\n  the form at <repl 1>:1:1\n") + "\nrestarts" in said


@pytest.mark.soak
def test_an_answer_of_cramhy_eval_has_them(cramhy):
    assert (
        '"backtrace": "calls, the innermost last:\\n  the form at <repl 1>:1:1"'
        in cramhy("eval", "--backtrace", "lisp", input='{"form": "(car 5)"}\n').stdout
    )
    assert "backtrace" not in cramhy("eval", input='{"form": "(car 5)"}\n').stdout
