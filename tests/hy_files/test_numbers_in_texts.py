"""Numbers in texts of the runtime: as Python writes them for users of Python and Hy, as Lisp prints them for users of Lisp."""

import re
from pathlib import Path

import pytest

from cramhy_runtime.lisp_core import conditions, data
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.printing import LISP_IS_SPOKEN, prin1_to_string
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

LISP = """(defpackage :numbers-in-texts (:use :cl))
(in-package :numbers-in-texts)
(define-condition too-far (error) ((metres :initarg :metres)) (:report (lambda (c s) (format s "~a is too far" (slot-value c 'metres)))))
(defclass robot () ((speed :initarg :speed :initform 1.5d0)))
(defmethod print-object ((robot robot) stream) (print-unreadable-object (robot stream) (prin1 (slot-value robot 'speed) stream)))
(defstruct pose (x 1.5d0) (y 2.5))
(defun drive () (error 'too-far :metres 1.5d0))
(defun tell () (error "~a and ~s" 1.5d0 2.5))
(defun first-of () (car 1.5d0))
(defun checked (x) (check-type x string))
(defun chosen (x) (ecase x (1 2)))
(defun divided () (/ 1.5d0 0))
(defun warned () (warn "speed ~a" 1.5d0))
(defun printed () (format nil "~a ~s" 1.5d0 2.5))
(defun stored () (list 1.5d0 2.5 (read-from-string (prin1-to-string 0.1d0)) (read-from-string (prin1-to-string 0.1))))
"""


TEXTS = {
    "lisp.drive()": ["1.5 is too far"],
    "lisp.tell()": ["1.5 and 2.5"],
    "lisp.first_of()": ["The value 1.5 is not of type LIST when binding LIST"],
    "lisp.checked(1.5)": ["The value of NUMBERS-IN-TEXTS::X is 1.5, which is not of type STRING."],
    "lisp.chosen(1.5)": ["1.5 fell through ECASE expression. Wanted one of (1)."],
    "lisp.divided()": ["arithmetic error DIVISION-BY-ZERO signalled Operation was (/ 1.5 0.0)."],
    "str(lisp.TooFar(metres=2.5e-30))": ["2.5e-30 is too far"],
    "pickle.loads(pickle.dumps(lisp.TooFar(metres=2.5)))": ["2.5 is too far"],
    "lisp.Robot()": ["#<1.5>"],
    "[lisp.Robot(speed=1e300)]": ["[#<1e+300>]"],
    "lisp.Pose()": ["#S(pose :X 1.5 :Y 2.5)"],
    "cpl.run(cpl.fail, 'at ~a', 1.5)": ["at 1.5"],
    "cpl.run(cpl.par, lambda: cpl.fail('at ~a', 1.5))": ["at 1.5"],
    "Motion(type=kw.driving, speed=1.5)": ["#<A MOTION (TYPE DRIVING) (SPEED 1.5)>"],
    "reference(Motion(type=kw.driving, speed=1.5))": [
        "Cannot resolve motion designator #<A MOTION (TYPE DRIVING) (SPEED 1.5)>.",
        "There is no clause of motion-grounding that could resolve it. Define one in a fact group that lists desig:motion-grounding, and "
        "load the file.",
    ],
    "explain(P.member(3.5, [1.5, 2]))": ["(member 3.5 (1.5 2)) has no solution. 3.5 is not among (1.5 2)."],
    "P.member(V.x, [1.5])": ["(member ?x (1.5))"],
    "first(P.member(V.x, [1.5]))": ["Answer(x=1.5)"],
    "first(P.membr(1.5))": ["Nobody has defined the predicate membr of the goal (membr 1.5). Did you mean member?"],
    "cpl.make_fluent(name='way', value=1.5)": ["#<FLUENT way [1.5]>"],
    "lisp.warned()": ["None"],
    # a function of Lisp prints as Lisp does, so it reads back what it has printed
    "lisp.printed()": ["1.5d0 2.5"],
    "lisp.stored()": ["(1.5 2.5 0.1 0.1)"],
}
"""What Python evaluates, and the texts that it then has: of the value, or of the exception and its notes."""

PYTHON = """
import pickle
import cramhy
import numbers_in_texts as lisp
from cramhy_runtime import cpl
from cramhy_runtime.designators import Motion, reference
from cramhy_runtime.prolog import P, V, explain, first, kw

for text in %r:
    try:
        value = eval(text)
        assert f"{value}" == str(value)
        found = [str(value)]
    except BaseException as problem:
        assert f"{problem}" == str(problem)
        found = [str(problem), *getattr(problem, "__notes__", ())]
    print([" ".join(each.split()) for each in found])
"""


@pytest.mark.soak
def test_python_sees_numbers_as_python_writes_them(python, tmp_path):
    (tmp_path / "numbers_in_texts.lisp").write_text(LISP)
    done = python("-c", PYTHON % (list(TEXTS),))
    assert dict(zip(TEXTS, map(eval, done.stdout.splitlines()), strict=True)) == TEXTS
    assert done.stderr == "WARNING: speed 1.5\n"


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "form, text",
    [
        ("(drive)", "1.5d0 is too far"),
        ("(tell)", "1.5d0 and 2.5"),
        ("(chosen 1.5d0)", "1.5d0 fell through ECASE expression.\nWanted one of (1)."),
        ('(cpl:fail "at ~a" 1.5d0)', "at 1.5d0"),
    ],
)
def test_a_session_of_lisp_tells_numbers_as_lisp_prints_them(form, text):
    with Image():
        session = Session(time="virtual")
        session.evaluate_text(LISP)
        with pytest.raises(BaseException) as caught:
            session.evaluate_text(form)
        assert isinstance(caught.value, Condition) and str(caught.value) == text
        assert prin1_to_string(1.5) == "1.5d0"


def test_each_image_has_its_own_language():
    with Image():
        Session(time="virtual")
        assert LISP_IS_SPOKEN.value
        with Image():
            assert not LISP_IS_SPOKEN.value and prin1_to_string(1.5) == "1.5" and str(conditions.SimpleError("~a", 1.5)) == "1.5"
        assert prin1_to_string(1.5) == "1.5d0"


TYPED = """(require cramhy *)
(make-fluent :name 'first :value 1.5)
(fail "at ~a" 1.5)
(ros-info (drive) "at ~a" 1.5)
(in-package :cl-user)
(cpl:make-fluent :name 'second :value 1.5d0)
(in-hy)
(make-fluent :name 'third :value 1.5)
"""


@pytest.mark.soak
def test_a_prompt_of_both_languages_changes_with_the_language(python):
    done = python("-m", "cramhy_runtime.cli", "repl", "--hy", input=TYPED)
    told = re.findall(r"#<FLUENT .*?>|at 1.5.*", done.stdout + done.stderr)
    assert sorted(told) == ["#<FLUENT FIRST [1.5]>", "#<FLUENT SECOND [1.5d0]>", "#<FLUENT THIRD [1.5]>", "at 1.5", "at 1.5"]


def test_the_old_name_of_doubles_warns_where_it_is_used():
    with pytest.warns(DeprecationWarning) as told:
        made = data.DoubleFloat("1.5"), isinstance(1.5, data.DoubleFloat), isinstance(1, data.DoubleFloat)
    assert made == (1.5, True, False) and type(made[0]) is float
    assert [Path(each.filename) for each in told] == [Path(__file__)] * 3
    assert str(told[0].message) == (
        "DoubleFloat goes away in cramhy 0.2. A double-float is a float of Python: write float instead of DoubleFloat."
    )
