"""FiveAM: what a run prints is what FiveAM 1.4 printed on SBCL for the same tests."""

import re

import pytest

from cramhy_runtime.lisp_core.conditions import Condition

TESTS = """
(defpackage :fiveam-tests (:use :cl :fiveam))
(in-package :fiveam-tests)
(clrhash 5am::*tests*) (5am:make-suite nil)
(def-suite all :description "All tests")
(def-suite sub :description "The sub suite" :in all)
(in-suite all)
(defun add (a b) (+ a b))
(test adding "Test addition."
  (is (= 4 (add 2 2))) (is (= 5 (add 2 2))) (is (equal "a" (add 2 2)) "The sum of ~a was wrong" 2)
  (is (evenp (add 1 2))) (is (not (evenp (add 2 2)))) (is (not (equal '(1) (list 1)))) (is (if t nil))
  (is-true (evenp 3)) (is-false (evenp 2) "no ~a" :really) (is-every = (4 (add 2 2)) (5 (add 2 2) "five ~a" 1))
  (signals error (error "x")) (signals (division-by-zero "~a" 5) (+ 1 1)) (signals type-error (+ 1 1))
  (finishes (+ 1 1)) (finishes (error "in finishes")) (pass))
(in-suite sub)
(test erring (is (= 1 1)) (error "Unexpected ~a" 'trouble) (is (= 1 2)))
(test good (is (= 1 1)))
(test (dep :depends-on erring) (is (= 1 1)))
(test (dep2 :depends-on (and good)) (is (= 1 1)))
(test (dep3 :depends-on (not good)) (is (= 1 1)))
(test (dep4 :depends-on (or good erring)) (is (= 1 1)))
(test empty)
"""


@pytest.fixture
def printed(values, session, capsys):
    """A function: what a form prints after the tests above were defined; addresses are ``{ID}``, blanks at line ends are gone."""

    def run(form):
        session.evaluate_text(TESTS, "<test>")
        session.package = "FIVEAM-TESTS"
        capsys.readouterr()
        session.evaluate_text(form, "<test>")
        text = re.sub(r"\{[0-9A-F]{10}\}", "{ID}", capsys.readouterr().out)
        return "\n".join(line.rstrip() for line in text.strip("\n").split("\n"))

    return run


def test_a_suite_with_its_suites(printed):
    assert (
        printed("(print (run! 'all))")
        == """\
Running test suite ALL
 Running test suite SUB
  Running test ERRING .X
  Running test GOOD .
  Running test DEP2 .
  Running test DEP4 .
  Running test EMPTY
 Running test ADDING .ffffffff.f.ff.Xf
 Did 23 checks.
    Pass: 8 (34%)
    Skip: 2 ( 8%)
    Fail: 13 (56%)

 Failure Details:
 --------------------------------
 ADDING in ALL [Test addition.]:

(ADD 2 2)

 evaluated to

4

 which is not

=

 to

5


 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:
      The sum of 2 was wrong
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:

(ADD 1 2)

 evaluated to

3

 which does not satisfy

EVENP


 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:

(ADD 2 2)

 evaluated to

4

 which satisfies

EVENP

 (it should not)
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:

(LIST 1)

 evaluated to

(1)

 which is

EQUAL

to

(1)

 (it should not be)
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:

(IF T
    NIL)

 was NIL.
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:
      (EVENP 3) did not return a true value
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:
      no REALLY
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:
      five 1
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:
      5
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:
      Failed to signal a TYPE-ERROR
 --------------------------------
 --------------------------------
 ADDING in ALL [Test addition.]:
      Unexpected Error: #<SIMPLE-ERROR "in finishes" {ID}>
in finishes.
 --------------------------------
 --------------------------------
 ERRING in SUB []:
      Unexpected Error: #<SIMPLE-ERROR "Unexpected ~a" {ID}>
Unexpected TROUBLE.
 --------------------------------

 Skip Details:
 DEP3 []:
     Dependencies not satisfied
 DEP []:
     Dependencies not satisfied


NIL"""
    )


def test_one_test_and_a_list(printed):
    assert (
        printed("(print (run! 'good))")
        == """\
Running test GOOD .
 Did 1 check.
    Pass: 1 (100%)
    Skip: 0 ( 0%)
    Fail: 0 ( 0%)


T"""
    )
    assert printed("(run! '(good dep2))").startswith("Running test GOOD .\nRunning test DEP2 .\n Did 2 checks.")


def test_without_names_and_with_another_explainer(printed):
    assert (
        printed("(explain (make-instance '5am::simple-text-explainer) (run 'sub :print-names nil) t)")
        == ".X...\n Ran 7 checks, 4 passed, 2 skipped  and 1 failed."
    )


def test_run_all_tests(printed):
    assert printed("(print (run-all-tests :summary nil))").startswith("Running test suite ALL\n Running test suite SUB")
    assert printed("(print (run-all-tests :summary :suite))").endswith("NIL")


def test_skipped_and_verbose(printed):
    assert (
        printed("""(in-suite sub) (test skips (is (= 1 1)) (skip "later ~a" 3) (skip "simply") (is (= 1 2) "differ"))
                      (let ((5am:*verbose-failures* t)) (run! 'skips))""")
        == """\
Running test SKIPS .ssssf
 Did 4 checks.
    Pass: 1 (25%)
    Skip: 2 (50%)
    Fail: 1 (25%)

 Failure Details:
 --------------------------------
 SKIPS in SUB []:
      differ
     (= 1 2)
 --------------------------------

 Skip Details:
 SKIPS []:
     simply
 SKIPS []:
     later 3"""
    )


def test_fixtures(printed):
    assert "Did 3 checks.\n    Pass: 3" in printed("""(def-suite* third :in all)
      (def-fixture five (&optional (n 5)) (let ((x n)) (&body)))
      (test fixed (with-fixture five () (is (= 5 x))) (with-fixture five (6) (is (= 6 x))))
      (def-test fixed2 (:fixture (five 7) :suite third) (is (= 7 x)))
      (run! 'third)""")


def test_random_data(printed):
    assert "Did 2 checks.\n    Pass: 2" in printed("""(test data
      (for-all ((a (gen-integer :min 0 :max 10)) (b (gen-integer :min 0 :max 10) (< a b))) (is (< a b)))
      (for-all ((s (gen-string :length (gen-integer :min 1 :max 3))) (c (gen-character :alphanumericp t)) (l (gen-list))
                (f (gen-float :bound 5)) (e (gen-one-element 1 2)) (b (gen-buffer)))
        (is (<= 1 (length s) 3)) (is (alphanumericp c)) (is (listp l)) (is (<= -5 f 5)) (is (member e '(1 2)))
        (is (every (lambda (byte) (typep byte '(unsigned-byte 8))) b))))
      (run! 'data)""")


def test_random_data_that_falsifies(printed):
    text = printed("""(test false-data (for-all ((a (gen-one-element 7))) (is (= a 8)))) (run! 'false-data)""")
    assert (
        """\
 FALSE-DATA in SUB []:
      Falsifiable with (7)
 Results collected with failure data:
    Did 1 check.
       Pass: 0 ( 0%)
       Skip: 0 ( 0%)
       Fail: 1 (100%)

    Failure Details:
    --------------------------------
    FALSE-DATA in SUB []:

8

 evaluated to

8

 which is not

=

 to

7


    --------------------------------"""
        in text
    )
    assert "Guard conditions never passed" in printed("(test guard (for-all ((a (gen-one-element 7) (= a 8))) (is (= a 8)))) (run! 'guard)")
    assert "No tests" in printed("(test nothing (for-all ((a (gen-integer))) a)) (run! 'nothing)")


def test_running_again_and_when_defined(printed):
    assert printed("(run! 'good) (!)").count("Running test GOOD .") == 2
    assert "Running test NOW ." in printed("(let ((*run-test-when-defined* t)) (eval '(test now (is (= 1 1)))))")


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "form, text",
    [
        ("(is 5)", "Argument to IS must be a list, not 5"),
        ("(in-suite no-such)", "Unknown suite NO-SUCH."),
        ("(def-suite y :in no-such)", "Unknown suite NO-SUCH."),
        ("(with-fixture none () 1)", "Unknown fixture NONE."),
        ("(run! 'no-such)", "Unknown test or suite NO-SUCH."),
        ("(progn (test (x :depends-on no-such) (is (= 1 1))) (run! 'x))", "Test X depends on NO-SUCH, which is no test."),
        ("(progn (test (r1 :depends-on r2) (is (= 1 1))) (test (r2 :depends-on r1) (is (= 1 1))) (run! 'r1))", ": R1 -> R2 -> R1."),
        ('(let ((*on-failure* :debug)) (test bad (is (= 1 2) "differ")) (run! \'bad))', "The following check failed: (= 1 2)\ndiffer."),
        ("(debug! 'erring)", "Unexpected TROUBLE"),
    ],
)
def test_what_is_wrong(printed, form, text):
    with pytest.raises(Condition) as caught:
        printed(form)
    assert text in caught.value.report()


def test_results(printed):
    assert (
        printed("""(format t "~{~S~%~}" (mapcar #'length (multiple-value-list (results-status (run 'sub :print-names nil)))))""")
        == ".X...0\n1\n2"
    )
    assert printed("(format t \"~S\" (list (get-test 'no-such :none) (rem-test 'good) (get-test 'good)))") == "(:NONE T NIL)"
