"""A package of 27 files in the manner of CRAM's upper layers loads without a word, and runs: ``barista/``, a robot that serves drinks.

The files are written as those of CRAM are: systems with modules, packages that shadow and import, structures, classes with all kinds of
methods, method combinations, facts that others extend, costmaps for location designators, plans, process modules, messages of its own. The
forms of ``pure_forms.lisp`` and ``object_forms.lisp`` need no CRAM; their answers are those of SBCL 2.2.9.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.streams.streams import StringOutputStream
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

HOME = Path(__file__).parent / "barista"
ALEXANDRIA = Path(__file__).parents[2] / "src" / "cramhy_runtime" / "libraries" / "alexandria"
ANSWER = """(lambda (form)
    (let ((*print-pretty* nil))
      (handler-case (prin1-to-string (eval form))
        (error (c) (format nil "~s" (list :error (type-of c) (princ-to-string c)))))))"""
SYSTEMS = "barista-common barista-tf barista-costmap barista-knowledge barista-plans".split()


@pytest.fixture(scope="module")
def barista():
    """A function: the printed values of the last form of a text, where the systems are loaded. ``said``: what loading them said."""
    with pytest.MonkeyPatch.context() as patch, Image():
        patch.setenv("ROS_PACKAGE_PATH", str(HOME))
        session = Session(time="virtual", turtlesim=False, seed=None)
        quiet = StringOutputStream()
        kept = streams.STANDARD_OUTPUT.value, streams.ERROR_OUTPUT.value
        streams.STANDARD_OUTPUT.value = streams.ERROR_OUTPUT.value = quiet
        try:
            for system in SYSTEMS:
                session.load(system)
            said = quiet.take()

            def answer(text, package="BARISTA-PLANS"):
                session.package = package
                return " ".join(" ".join(prin1_to_string(value).split()) for value in session.evaluate_text(text, "<test>"))

            answer.said, answer.session = said, session
            yield answer
        finally:
            streams.STANDARD_OUTPUT.value, streams.ERROR_OUTPUT.value = kept


def test_it_loads_without_a_word(barista):
    assert barista.said == ""
    assert len(list(HOME.glob("*/src/*.lisp"))) >= 20


@pytest.mark.parametrize("part", ["pure", "object"])
def test_the_parts_without_cram_give_what_sbcl_gives(barista, part):
    expected = (HOME / f"{part}_answers.txt").read_text().rstrip("\n").split("\n=\n")
    barista.session.package = "COMMON-LISP-USER"
    barista.session.evaluate_text(f"(defvar *log* nil) (defparameter *answer* {ANSWER})")
    reader = barista.session.reader((HOME / f"{part}_forms.lisp").read_text(), "<forms>")
    answer = barista.session.evaluate_text("*answer*")[0]
    found = [(form, str(answer(form))) for form in barista.session.forms(reader)]
    assert len(found) == len(expected)
    for (form, value), wanted in zip(found, expected):
        assert value == wanted.rstrip("\n").removesuffix("\n="), prin1_to_string(form)


@pytest.mark.soak
@pytest.mark.skipif(shutil.which("sbcl") is None, reason="sbcl is not installed")
@pytest.mark.parametrize("part", ["pure", "object"])
def test_the_answers_are_those_of_sbcl(tmp_path, part):
    (tmp_path / "cram-language.asd").write_text('(defsystem "cram-language")')
    (tmp_path / "go.lisp").write_text(f"""
        (require :asdf)
        (asdf:initialize-output-translations '(:output-translations (t ("{tmp_path}/fasl/" :implementation)) :ignore-inherited-configuration))
        (dolist (folder '(#p"{ALEXANDRIA}/" #p"{tmp_path}/" #p"{HOME}/barista_common/")) (push folder asdf:*central-registry*))
        (defpackage :cpl (:use :cl) (:nicknames :cram-language) (:export #:simple-plan-failure))
        (define-condition cpl:simple-plan-failure (error) ())
        (defpackage :cram-prolog (:use :cl) (:export #:def-fact-group #:<- #:prolog))
        (defpackage :cut (:use :cl) (:export #:var-value #:lazy-car #:force-ll #:lazy-mapcar #:with-vars-bound #:is-var))
        (defpackage :cl-transforms (:use :cl) (:export #:pose))
        (defclass cl-transforms:pose () ())
        (handler-bind ((warning #'muffle-warning))
          (let ((*standard-output* (make-broadcast-stream)) (*error-output* (make-broadcast-stream)))
            (asdf:load-system :barista-common)
            (dolist (file '("package" "objects")) (load (format nil "{HOME}/barista_knowledge/src/~a.lisp" file)))))
        (in-package :cl-user)
        (defvar *log* nil)
        (with-open-file (in "{HOME}/{part}_forms.lisp")
          (loop with answer = {ANSWER}
                for form = (read in nil in) until (eq form in)
                do (format t "~a~%=~%" (funcall answer form))))""")
    done = subprocess.run(
        ["sbcl", "--noinform", "--non-interactive", "--load", str(tmp_path / "go.lisp")], capture_output=True, text=True, timeout=120
    )
    assert done.stdout.split("\n=\n") == (HOME / f"{part}_answers.txt").read_text().split("\n=\n")


class TestFramesAndCostmaps:
    @pytest.mark.parametrize(
        "form, answer",
        [
            ("(pose->list (base-pose))", '("map" (1.0d0 2.0d0 0.0d0) (0.0d0 0.0d0 0.0d0 1.0d0))'),
            ('(with-frames (:base "nowhere") (handler-case (base-pose) (bc:barista-failure (f) (princ-to-string f))))',
             '"Where is the base? TIMEOUT-ERROR"'),
            ('(pose->list (pose-in-frame "base_footprint" (ensure-pose \'((3 3 0)))))',
             '("base_footprint" (2.0d0 1.0d0 0.0d0) (0.0d0 0.0d0 0.0d0 1.0d0))'),
            ("(pose->list (translate-pose (ensure-pose (bc:make-position 1 2)) :x 1))",
             '("map" (2.0d0 2.0d0 0.0d0) (0.0d0 0.0d0 0.0d0 1.0d0))'),
            ("(cut:force-ll (cut:lazy-take 2 (cut:lazy-mapcar (lambda (p) (round (* 10 (x (origin p))))) "
             "(poses-near (ensure-pose '((0 0 0)))))))", "(5 0)"),
            ("(length (cut:force-ll (prolog `(and (pose ,(list->pose '((1 2 3))) ?p) (frame ?p \"map\")))))", "1"),
            ("(handler-case (strip-stamp 3) (type-error (e) (type-error-datum e)))", "3"),
        ],
    )  # fmt: skip
    def test_frames(self, barista, form, answer):
        assert barista(f"(init-frames) (set-base-pose (list->pose '((1 2 0)))) {form}", "BARISTA-TF") == answer

    @pytest.mark.soak(all_but=3)
    @pytest.mark.parametrize(
        "form, answer",
        [
            ("(let ((m (make-costmap :center (make-3d-vector 1 1 0)))) (register-function m (near-to (make-3d-vector 1 1 0) 1))"
             "(register-function m #'+ 'plus) (register-function m 'max)"
             "(list (mapcar #'function-name (sorted-functions m)) (fourth (bc:grid->list (costmap-values m)))))",
             "((NEAR-TO MAX PLUS) (0.0d0 0.0d0 1.875d0 2.5d0 3.125d0 5.25d0 0.0d0 0.0d0))"),
            ("(handler-case (costmap-values (make-costmap)) (no-functions (c) (princ-to-string c)))", '"The costmap has no functions yet."'),
            ("(let ((*sampling-function* (lambda (limit) (* 0.5 limit)))) (btf:pose->list (reference *d*)))",
             '("map" (1.25d0 1.25d0 0.0d0) (0.0d0 0.0d0 0.0d0 1.0d0))'),
            ("(let ((m (designator-costmap *d*))) (list (eq m (designator-costmap *d*)) (mapcar #'function-name (sorted-functions m))"
             "(costmap-location-validator *d* (btf:ensure-pose '((1.2 1.2 0)))) (costmap-location-validator *d* (btf:ensure-pose '((-5 1 0))))"
             "(costmap-location-validator *d* (btf:ensure-pose '((0.6 1.2 0)))) (costmap-location-validator *d* 3)))",
             "(T (NEAR-TO IN-HALF-PLANE GAUSS) :ACCEPT :REJECT :REJECT :UNKNOWN)"),
            ("(let ((log '())) (handler-bind ((warning (lambda (w) (push (princ-to-string w) log) (muffle-warning w))))"
             "(let ((m (make-costmap))) (register-function m (constantly 0) 'zero) (costmap-values m))) log)",
             '("No place fits #<COSTMAP 8x8>.")'),
            ("(handler-case (let ((*print-readably* t)) (prin1-to-string (make-costmap))) (print-not-readable () :refused))", ":REFUSED"),
            ("(handler-bind ((type-error (lambda (c) (store-value :x c)))) (funcall (function-of (in-half-plane :z)) 1 2))", "1"),
            ("(list (< 1 2 3) (> 1 2) (documentation 'near-to 'function))", '(T NIL "1 up to DISTANCE from PLACE, then 0.")'),
        ],
    )  # fmt: skip
    def test_costmaps(self, barista, form, answer):
        designator = "(make-designator :location `((:near ,(make-3d-vector 1 1 0)) (:distance 1) (:side (:x :positive))))"
        assert barista(f"(btf:init-frames) (defparameter *d* {designator}) {form}", "BARISTA-COSTMAP") == answer


class TestKnowledge:
    @pytest.mark.parametrize(
        "form, answer",
        [
            ("(force-ll (lazy-mapcar (lambda (b) (list (var-value '?n b) (var-value '?k b))) (prolog '(kind-of ?n ?k))))",
             "((:BLUE MUG) (:CLEAR GLASS) (:SILVER TRAY))"),
            ("(mapcar #'cdar (force-ll (prolog '(graspable :blue ?g))))", "(:HANDLE :SIDE :TOP)"),
            ("(mapcar #'best-grasp (list (find-thing :blue) (find-thing :clear) (find-thing :silver)))", "(:SIDE :SIDE :EDGES)"),
            ("(list (and (prolog '(fits-on :silver)) t) (prolog '(fits-on :blue)) (prolog '(heavier :blue :clear)))", "(T NIL NIL)"),
            ("(var-value '?n (lazy-car (prolog '(serving-order ?n))))", "(:CLEAR :BLUE)"),
            ("(force-ll (prolog '(free-arm ?arm (:left))))", "(((?ARM . :RIGHT)))"),
            ("(with-vars-bound (?arm) (lazy-car (prolog '(free-arm ?arm nil))) ?arm)", ":LEFT"),
            ("(prolog '(kind-of :nothing ?k))", "NIL"),
        ],
    )  # fmt: skip
    def test_rules(self, barista, form, answer):
        things = "(forget-things) (add-thing 'mug :blue) (add-thing 'glass :clear) (add-thing 'tray :silver) (pour :milk (find-thing :clear) 0.1)"
        assert barista(f"{things} {form}", "BARISTA-KNOWLEDGE") == answer


class TestPlans:
    def test_three_guests_are_served(self, barista):
        served, log = barista("(mapcar (lambda (list) (format nil \"~{~s~^ ~}\" list)) (multiple-value-list "
                              "(let ((bcm:*sampling-function* (lambda (limit) (* 0.5 limit)))) (run-demo))))").split('" "')  # fmt: skip
        assert served == '("(CUP-1 0.0d0) (GLASS-1 0.0d0) (MUG-1 1.0d0)'
        assert "at 1.3 1.3" in log and log.count("event cup-taken") == log.count("hands: 0") == 3
        assert log.count("does not fit; a little less") == 3

    @pytest.mark.parametrize(
        "drops, slips, answer", [(0, 0, "((CUP-1 0.0d0))"), (3, 3, "((CUP-1 0.0d0))"), (9, 6, '((:FAILED "cup-1 slips"))')]
    )
    def test_a_cup_that_slips_is_taken_again(self, barista, drops, slips, answer):
        assert barista(f"(reset-world) (setf *drop-next* {drops}) (serve-guests '((cup-1 :milk (0 2))))") == answer
        assert barista('(count-if (lambda (line) (search "slips" line)) *log*)') == str(slips)

    def test_a_cup_that_is_not_there(self, barista):
        assert (
            barista("(reset-world) (list (serve-guests '((no-cup :milk (0 2)))) *log*)") == '(((:FAILED "nothing to fetch")) ("no no-cup"))'
        )

    def test_a_branch_that_wins_stops_the_other(self, barista):
        form = "(top-level (with-barista (let ((?g (place 4 0))) (pursue (wait-for (cpl:< (distance-to ?g) 2.5)) (drive-to ?g)))))"
        assert barista(f"(reset-world) {form} (cl-transforms:x (cl-transforms:origin (value *robot-pose*)))") == "2.0d0"

    def test_occasions(self, barista):
        held = "(setf (value *held*) (list (cons :left (find-thing 'mug-1))))"
        assert (
            barista(f"(reset-world) {held} (cut:force-ll (prolog '(holds (cup-held ?arm ?name))))") == "(((?ARM . :LEFT) (?NAME . MUG-1)))"
        )
        assert barista("(cut:force-ll (prolog '(holds (robot-at ?x ?y))))") == "(((?X . 0) (?Y . 0)))"

    def test_messages_and_services_of_its_own(self, barista):
        barista('(reset-world) (roslisp:start-ros-node "barista") (defparameter *trays* (watch-trays)) (start-brewing)')
        barista('(roslisp:publish (roslisp:advertise "/trays" "barista_msgs/Tray") (tray-message (list (find-thing \'cup-1))))')
        assert (
            barista("(value *trays*)")
            == '("the house" ("cup-1" 0 2.0d0 (0.07999999821186066d0 0.07999999821186066d0 0.20000000298023224d0) "map"))'
        )
        assert barista("(list (brew :latte) (multiple-value-list (brew :espresso 10)))") == '(:LATTE (NIL "too strong"))'
        codes = "(mapcar (lambda (name) (roslisp-msg-protocol:symbol-code 'barista_msgs-msg:cup name)) '(:mark :nobody :full))"
        assert barista(codes) == '("# 7 of the set" "" 1)'
        assert barista("(roslisp-msg-protocol:md5sum 'barista_msgs-msg:cup)") == '"a7eed4363c0100d5ddd0fbd67514e106"'


class TestThreads:
    """The one system of the package that needs SB-THREAD, bordeaux-threads and trivial-garbage."""

    @pytest.fixture
    def threads(self, barista):
        barista.session.load("barista-threads")
        return barista

    @pytest.mark.soak(all_but=1)
    @pytest.mark.parametrize(
        "form, answer",
        [
            ("(count-up 3 20)", "((0 1 2) 60)"),
            ("(let ((thing (list 1))) (note-thing thing :kept) (list (noted thing) (noted (list 1))))", "(:KEPT :NOTHING)"),
            ("(add-under-lock '(a) 'b)", "(A B)"),
            ("(length (orders-with-mutex '(a b c)))", "3"),
            ("(watch-with-timeout 1)", ":TIMED-OUT"),
        ],
    )
    def test_they_share(self, threads, form, answer):
        assert threads(form, "BARISTA-THREADS") == answer
