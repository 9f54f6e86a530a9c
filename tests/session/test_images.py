"""Images side by side in one process: neither hears of the other, whatever is defined or runs in it."""

import gc
import sys
import threading
import weakref
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.fluents.fluents import living_fluents
from cramhy_runtime.designators import Motion
from cramhy_runtime.prolog import kw
from cramhy_runtime.designators.classes import living
from cramhy_runtime.lisp_core.packages import _definitions, _ours, _users_packages, all_packages, common, find_package
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.kernel import images
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image
from cramhy_runtime.turtlesim.node import running_simulator

sys.path.insert(0, str(Path(__file__).parents[2] / "tutorials"))
try:
    import lectures
finally:
    sys.path.pop(0)


def evaluate(text, **options):
    """The values of the last form of ``text``, in a session in the current image."""
    return Session(time="virtual", turtlesim=False, **options).evaluate_text(text)


# ------------------------------------------------------------------------------------------------------------------- alone


def test_what_is_defined_in_an_image_is_not_known_outside():
    text = """
    (defpackage :secret (:use :cpl :cpm) (:import-from :prolog #:def-fact-group #:<-))
    (in-package :secret)
    (defvar *here* (make-fluent :name "here"))
    (defun f () 1)
    (defclass thing () ((a :accessor a-of)))
    (defmethod desig:reference ((d thing) &optional role) role)
    (def-fact-group secrets (desig:motion-grounding) (<- (desig:motion-grounding ?d ?d)) (<- (told ?x)))
    (def-process-module secret-module (d) d)
    (def-top-level-cram-function secret-plan () 7)
    (push :secret *features*)
    (setf *print-base* 2)
    (desig:register-location-generator 1 f)
    (secret-plan)
    """
    evaluate("(cpl:top-level (cpl:par 1))")  # what is loaded when somebody first compiles is loaded
    before = _everything()
    with Image(as_now=True):
        evaluate(text)
        assert find_package("SECRET")
        assert _changes(before)
    assert _changes(before) == []
    assert find_package("SECRET") is None


def test_a_package_of_ours_that_a_program_makes_anew_is_in_other_images_as_it_was():
    """As checkouts of CRAM's libraries do, which use packages of theirs in it."""
    text = """
    (defpackage :their-utilities (:use :cl) (:export #:helper #:other))
    (defpackage :cl-transforms (:use :cl :their-utilities) (:nicknames :anew) (:import-from :their-utilities #:other) (:export #:other))
    (list (eq 'cl-transforms::helper 'their-utilities:helper) (eq 'anew:other 'their-utilities:other) (helper-of-theirs))
    """
    uses = "(package-use-list :cl-transforms)"
    with Image():
        before = evaluate(uses)[0]
        for value in (1, 2):
            with Image():
                evaluate(f"(defun helper-of-theirs () {value})")
                assert list(evaluate(text)[0]) == [True, True, value]
                assert "THEIR-UTILITIES" in str(evaluate(uses)[0])
            assert list(evaluate(uses)[0]) == list(before)
            assert list(evaluate('(list (find-symbol "OTHER" :cl-transforms) (package-nicknames :cl-transforms))')[0]) == [None, None]


def test_a_class_of_ours_that_a_program_makes_anew_is_in_other_images_as_it_was():
    vector, check = "(cl-transforms:make-3d-vector 1 2 3)", "(typep (cl-transforms:make-3d-vector 1 2 3) 'cl-transforms:3d-vector)"
    with Image():
        ours = evaluate("(find-class 'cl-transforms:3d-vector)")[0]
        for value in (1, 2):
            with Image():
                evaluate(f"(defclass cl-transforms:3d-vector () ((a :initform {value} :accessor a-of)))")
                assert evaluate("(a-of (make-instance 'cl-transforms:3d-vector))") == [value]
                evaluate("(defclass cl-transforms::of-theirs () ())")
            assert evaluate("(find-class 'cl-transforms:3d-vector)") == [ours]
            assert evaluate(check) == [True] and evaluate(f"(class-of {vector})") == [ours]
            assert evaluate("(find-class 'cl-transforms::of-theirs nil)") == [None]


def test_a_new_image_knows_nothing_of_what_was_defined_before():
    with Image(as_now=True):
        evaluate(
            "(defpackage :earlier (:use :cl)) (defun earlier::f () 1) (cpm:def-process-module earlier::m (d) d) (defvar cl-user::*x* 1)"
        )
        with Image():
            assert find_package("EARLIER") is None
            assert evaluate("(list (cpm:get-process-module-names) (boundp '*x*))")[0].car is None
        with Image(as_now=True):
            assert evaluate("(earlier::f)") == [1]
            evaluate('(defun earlier::f () 2) (setf *x* 3) (intern "ANOTHER" :earlier)')
            assert list(evaluate("(list (earlier::f) *x*)")[0]) == [2, 3]
        assert list(evaluate('(list (earlier::f) *x* (find-symbol "ANOTHER" :earlier))')[0]) == [1, 1, None]


def test_addresses_are_counted_in_each_image():
    def shown():
        with Image():
            session = Session(time="virtual", turtlesim=False)
            return session.evaluate_text(
                '(progn (defclass cup () ()) (format nil "~a ~a" (make-instance (quote cup)) (make-instance (quote cup))))'
            )

    first = shown()
    assert "{1001000043}" in first[0] and "{1001000083}" in first[0]
    assert shown() == first


def test_an_image_may_be_left_and_entered_again():
    image = Image()
    with image.entered():
        evaluate("(defparameter cl-user::*count* 1)")
    with Image(), image.entered():
        assert evaluate("(incf cl-user::*count*)") == [2]
    with image.entered():
        assert evaluate("cl-user::*count*") == [2]
    image.close()
    with image.entered():
        assert evaluate("(boundp 'cl-user::*count*)") == [None]
    image.close()


def test_plans_of_an_image_go_on_where_they_were_when_it_is_entered_again():
    image, steps = Image(), []

    def walk():
        for step in range(3):
            steps.append(step)
            cpl.sleep(1)

    with image.entered():
        image.start()
        task = kernel.spawn(lambda: cpl.top_level(walk))
        kernel.sleep(0.5)
    assert steps == [0] and kernel.active() is not task.kernel
    with image.entered():
        assert kernel.active() is task.kernel
        task.join()
        assert steps == [0, 1, 2] and kernel.now() == 3.0
    image.close()


def test_dynamic_bindings_and_handlers_belong_to_the_image():
    from cramhy_runtime.lisp_core.conditions import SimpleError, error, handler_bind
    from cramhy_runtime.lisp_core.dynamic import binding
    from cramhy_runtime.lisp_core.packages import sym

    heard = []
    with Image(as_now=True):
        kernel.start()
        with binding(sym("*PRINT-BASE*"), 2):

            def inside():
                with Image():
                    kernel.start()
                    assert sym("*PRINT-BASE*").value == 10
                    with pytest.raises(SimpleError):
                        error("not for the handler outside")
                assert sym("*PRINT-BASE*").value == 2
                with pytest.raises(SimpleError):
                    error("for the handler outside")

            handler_bind([(SimpleError, heard.append)], inside)
        assert sym("*PRINT-BASE*").value == 10
    assert [str(each) for each in heard] == ["for the handler outside"]


def test_an_error_inside_leaves_the_image():
    before = images.current()
    with pytest.raises(ZeroDivisionError), Image():
        raise ZeroDivisionError
    assert images.current() is before


def test_what_was_defined_in_an_image_goes_with_it():
    with Image():
        (fluent,) = evaluate("(defvar cl-user::*kept* (cpl:make-fluent))  cl-user::*kept*")
        gone = weakref.ref(fluent)
        del fluent
    gc.collect()
    assert gone() is None


def test_an_image_is_entered_by_one_thread_at_a_time():
    refused = []

    def other(image):
        try:
            image.enter()
        except kernel.KernelError as problem:
            refused.append(str(problem))

    with Image() as image:
        thread = threading.Thread(target=other, args=(image,))
        thread.start()
        thread.join()
    assert refused == ["Another thread is in this image. An image is entered by one thread at a time; make one for each."]


def test_the_current_image_is_not_forgotten():
    with Image() as image, pytest.raises(kernel.KernelError, match="Leave it first"):
        image.forget()


def test_starting_an_image_that_is_not_entered_is_an_error():
    with pytest.raises(kernel.KernelError, match="Enter it first"):
        Image().start()


# -------------------------------------------------------------------------------------------------------------- side by side


@pytest.fixture
def quick_turns(monkeypatch):
    """Threads change turns as soon as another one waits, so that they do it all the time."""
    monkeypatch.setattr(images, "QUANTUM", 0)


def together(*works):
    """Call each of ``works`` in a thread and an image of its own; all begin before one of them goes on. Their results."""
    results, problems, begun = [None] * len(works), [], threading.Barrier(len(works))

    def run(number, work):
        try:
            with Image():
                with images.outside():
                    begun.wait(60)
                results[number] = work()
        except BaseException as problem:
            problems.append(problem)

    threads = [threading.Thread(target=run, args=each) for each in enumerate(works)]
    for thread in threads:
        thread.start()
    with images.outside():  # this thread is in the image of this file
        for thread in threads:
            thread.join()
    if problems:
        raise problems[0]
    return results


def lecture(seed, backend, order):
    """Lecture 38, in an image of its own; the turtle notes in ``order`` whose turn it is whenever it moves."""

    def draw():
        session = Session(time="virtual", seed=seed, backend=backend)
        kernel.active().watch_instants(lambda: order.append(seed))
        for form in lectures.LECTURE_38:
            session.evaluate_text(form)
        simulator = running_simulator()
        (turtle,) = simulator.turtles.values()
        return bytes(simulator.canvas.rgb()), (turtle.x, turtle.y), kernel.now()

    return draw


@pytest.mark.soak
def test_two_images_run_the_lecture_at_once_each_with_its_turtle(backend, quick_turns):
    order = []
    (one, place_of_one, _), (other, place_of_other, _) = together(lecture(1, backend, order), lecture(2, backend, order))
    assert one != other, "the colours are drawn by lot, so the papers differ"
    assert sum(left != right for left, right in zip(order, order[1:])) > 100, "they ran one after the other"
    order.clear()
    alone, place, _ = together(lecture(1, backend, order))[0]
    assert (alone, place) == (one, place_of_one), "beside another one the lecture ran as it does alone"


def test_a_busy_plan_lets_the_other_image_have_its_turn(backend, quick_turns):
    loop = "(cpl:top-level (loop until cl-user::*done*))"
    done = threading.Event()

    def busy():
        session = Session(time="virtual", backend=backend, turtlesim=False)
        session.evaluate_text("(defvar *done* nil)")
        variable = find_package("CL-USER").intern("*DONE*")
        kernel.call_every(0.005, lambda: done.is_set() and setattr(variable, "value", True))
        return session.evaluate_text(loop)

    def short():
        done.set()
        return True

    assert together(busy, short)[1] is True


def test_a_session_that_waits_in_wall_time_holds_up_nobody():
    waits, done = threading.Event(), threading.Event()

    def waiting():
        kernel.start(clock="wall")
        waits.set()
        kernel.run_blocking(done.wait, 60)
        return done.is_set()

    def other():
        with images.outside():
            waits.wait(60)
        done.set()
        return True

    assert together(waiting, other) == [True, True]


# ----------------------------------------------------------------------------------------------------------------- at random


def _everything():
    """What users' packages hold, and what all symbols mean that all images share; to be compared."""
    kept = {}
    for package in all_packages():
        if package in _users_packages():
            kept[package.name] = (dict(package.external), dict(package.internal), list(package.use))
        if _ours.get(package.name) is package:
            for symbol in (*package.external.values(), *package.internal.values()):
                if symbol.__class__ is Symbol and common(symbol) and symbol.package is package:
                    kept[symbol] = [id(each) for each in _definitions(symbol)]
    return kept


def _changes(before):
    """What is not as it was; names that somebody has read since are none."""
    after = _everything()
    return [str(key) for key, value in before.items() if after.get(key) != value]


DEFINITIONS = st.sampled_from(
    [
        "(defun {0} (x) x)",
        "(defmacro {0} (x) x)",
        "(defvar {0} 1)",
        "(defparameter {0} 2)",
        "(defstruct {0} a)",
        "(defclass {0} () ((b :accessor {0})))",
        "(defgeneric {0} (x))",
        "(defmethod {0} ((x integer)) x)",
        "(define-modify-macro {0} (x) +)",
        "(define-symbol-macro {0} 5)",
        "(deftype {0} () 'integer)",
        "(setf (get '{0} 'note) 1)",
        "(setf (symbol-function '{0}) #'car)",
        "(setf (macro-function '{0}) (lambda (form environment) form))",
        "(defun (setf {0}) (new x) (list new x))",
        "(fmakunbound '{0})",
        "(makunbound '{0})",
        "(proclaim '(special {0}))",
        "(setf (fdefinition '{0}) (lambda (x) x))",
        "(cpl:def-cram-function {0} () 1)",
        "(cpl:def-top-level-cram-function {0} () 1)",
        "(prolog:def-fact-group {0} (prolog:member) (prolog:<- (prolog:member ?a ?b) (prolog:fail)))",
        "(cpm:def-process-module {0} (d) d)",
        "(cpl:define-task-variable {0} 1)",
        "(setf {0} 5)",
    ]
)
NAMES = st.sampled_from(
    "cl-user::mine cl:first cl:list cl:*print-base* cpl:wait-for cpl:par cpl:value desig:reference cut:compose roslisp:publish "
    "coe:holds cpm:pm-execute prolog:prolog cl-user::*another* cram-user::plan".split()
)


@pytest.mark.soak
@settings(deadline=None)
@given(st.lists(st.tuples(DEFINITIONS, NAMES), min_size=1, max_size=4))
def test_whatever_is_defined_the_image_outside_stays_as_it_was(definitions):
    with Image(as_now=True):
        evaluate("1")
        before = _everything()
        with Image(as_now=True):
            session = Session(time="virtual", turtlesim=False)
            for definition, name in definitions:
                try:
                    session.evaluate_text(f"(sb-ext:without-package-locks {definition.format(name)})")
                except BaseException as problem:
                    if isinstance(problem, (KeyboardInterrupt, SystemExit, RecursionError)):
                        raise
        assert _changes(before) == []


def test_a_name_that_a_program_exports_from_a_package_of_ours_is_external_in_its_image_alone():
    with Image():
        session = Session(time="virtual", turtlesim=False)
        for package in ("roslisp", "cram-utilities"):
            session.evaluate_text(f"(sb-ext:without-package-locks (defpackage :{package} (:export #:mine-alone)))")
        with Image():
            text = '(defpackage :both (:use :roslisp :cram-utilities)) (nth-value 1 (find-symbol "MINE-ALONE" :roslisp))'
            inside = Session(time="virtual", turtlesim=False).evaluate_text(text)
            kernel.stop()
        assert str(inside[-1]) != ":EXTERNAL"
        assert str(session.evaluate_text('(nth-value 1 (find-symbol "MINE-ALONE" :roslisp))')[-1]) == ":EXTERNAL"
        kernel.stop()


def test_a_new_image_begins_without_the_fluents_and_designators_of_the_first():
    first_fluent, first_designator = cpl.make_fluent(name="first"), Motion(type=kw.driving)
    for as_now in (False, True):
        with Image(as_now=as_now) as image:
            assert (living_fluents(), living()) == ([], [])
            with image.entered():
                mine, designator = cpl.make_fluent(name="mine"), Motion(type=kw.driving)
            assert (living_fluents(), living()) == ([mine], [designator])
            del mine, designator
            gc.collect()
            assert (living_fluents(), living()) == ([], [])
    assert first_fluent in living_fluents()
    assert first_designator in living()
