"""What CRAM-DESIGNATORS, CRAM-PROLOG and CRAM-MATH have since CRAM's branch devel."""

import itertools

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

numbers = itertools.count(1)
PLACES = """(defun five-places (designator) (declare (ignore designator)) (list 1 2 3 4 5))
  (defun even-place (designator solution) (declare (ignore designator)) (if (evenp solution) :accept :reject))
  (desig:register-location-generator 5 five-places) (desig:register-location-validation-function 5 even-place)
  (defvar *place* (desig:a location (near :table)))"""


@pytest.fixture
def lisp():
    with Image(as_now=True):
        session = Session(time="virtual", turtlesim=False)

        def evaluate(text):
            return " ".join(" ".join(map(prin1_to_string, session.evaluate_text(text))).split())

        evaluate(f"(defpackage :newer-desig-{next(numbers)} (:use :cl :prolog)) ")
        session.package = f"NEWER-DESIG-{next(numbers) - 1}"
        yield evaluate
        kernel.stop()
        PACKAGE.value = COMMON_LISP_USER


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    ("form", "values"),
    [
        (
            """(let* ((old (desig:an action (type going) (target :door) (speed 3)))
                      (new (desig:rename-designator-property-key old :target :goal)))
                 (list (desig:properties new) (desig:desig-prop-value old :target) (desig:desig-equal old new) (type-of new)))""",
            "(((:TYPE :GOING) (:SPEED 3) (:GOAL :DOOR)) :DOOR NIL DESIG:ACTION-DESIGNATOR)",
        ),
        (
            "(desig:properties (desig:rename-designator-property-key (desig:an action (type going)) :target :goal))",
            "((:TYPE :GOING) (:GOAL))",
        ),
        ("(mapcar (lambda (sets) (and (prolog `(subset ,@sets)) t)) '(((1 2) (3 2 1)) ((1 4) (3 2 1)) (() (1)) (() ()) ((1) ()) ((1 1) (1))))", "(T NIL T T NIL T)"),
        ("(prolog:prolog '(and (subset (?x) (1 2)) (== ?x 5)))", None),
        ('(progn (asdf:load-system "cram-math") (read-from-string "nil"))', "NIL 3"),
    ],
)  # fmt: skip
def test_the_functions(lisp, form, values):
    said = lisp(form).replace("CRAM-DESIGNATORS:", "DESIG:")
    assert said == values or values is None and said.startswith("(((")


def test_the_middle_of_two_numbers(lisp):
    lisp('(asdf:load-system "cram-math")')
    assert lisp("(list (cram-math:average 2 4) (cram-math:average 1 2) (cram-math:average '(1 2 6)))") == "(3 3/2 3)"


def test_reset_gives_an_equated_designator_without_solutions(lisp):
    text = """(list (desig:reference *place*) (let ((new (desig:reset *place*)))
                (list (eq new *place*) (desig:desig-equal new *place*) (eq (desig:current-desig *place*) new)
                      (desig:reference new))))"""
    assert lisp(PLACES + text) == "(2 (NIL T T 2))"


def test_a_class_of_the_user_may_be_reset_in_its_own_way(lisp):
    assert lisp("(defclass thing () ()) (defmethod desig:reset ((thing thing)) :again) (desig:reset (make-instance 'thing))") == ":AGAIN"


def test_the_places_of_a_location_are_a_lazy_list(lisp):
    assert lisp(f"{PLACES} (cut:force-ll (desig:resolve-location-designator-through-generators-and-validators *place*))") == "(2 4)"
    with pytest.raises(Condition):
        lisp("(desig:resolve-location-designator-through-generators-and-validators (desig:an action (type going)))")


def test_a_method_around_the_resolution_of_locations_gives_the_list_of_places(lisp):
    """As cram-manipulation-interfaces does it."""
    text = """(defmethod desig:resolve-designator :around ((desig desig:location-designator) role)
                (declare (ignore role))
                (cut:lazy-mapcar (lambda (place) (* 10 place))
                                 (desig:resolve-location-designator-through-generators-and-validators desig)))
              (let ((next (progn (desig:reference *place*) (desig:next-solution *place*))))
                (list (desig:reference *place*) (desig:reference next) (desig:next-solution next)))"""
    assert lisp(PLACES + text) == "(20 40 NIL)"


def test_verdicts_of_validators_are_printed_on_demand(lisp, capsys):
    lisp(f"{PLACES} (desig:reference (desig:a location (near :table)))")
    assert "says" not in capsys.readouterr().out
    lisp("(let ((desig:*print-location-validation-function-results* t)) (desig:reference (desig:a location (near :chair))))")
    said = capsys.readouterr().out.splitlines()
    assert [line for line in said if "EVEN-PLACE" in line] == ["validator EVEN-PLACE says: REJECT", "validator EVEN-PLACE says: ACCEPT"]


def test_a_variable_may_stand_for_a_property(lisp):
    form = "(let ((?side '(:side :left)) (?nothing nil)) (desig:properties (desig:a location (on :table) ?side ?nothing)))"
    assert lisp(form) == "((:ON :TABLE) (:SIDE :LEFT))"


def test_methods_of_events_that_have_a_number_run_first(lisp):
    lisp("""(defvar *said* ()) (defclass happened (coe:event) ())
      (defmethod coe:on-event last-one ((event happened)) (push :last *said*))
      (defmethod coe:on-event second-one 2 ((event happened)) (push :second *said*))
      (defmethod coe:on-event first-one 1 ((event happened)) (push :first *said*))""")
    assert lisp("(progn (coe:on-event (make-instance 'happened)) (reverse *said*))") == "(:FIRST :SECOND :LAST)"


def test_the_goal_of_an_action_is_asked_before_its_grounding(lisp):
    """CRAM's branch master resolves the action first, and fails where nothing grounds it."""
    lisp("(def-fact-group occasions (coe:holds) (<- (coe:holds (done))))")
    form = "(handler-bind ((warning #'muffle-warning)) (cpl:top-level (exe:perform (desig:an action (type never-grounded) (goal (done))))))"
    assert lisp(form.replace("(done)", "?done").replace("(cpl:top-level", "(let ((?done '(done))) (cpl:top-level") + ")") == "NIL"
