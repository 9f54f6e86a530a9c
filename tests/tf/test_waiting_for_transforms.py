"""Waiting for transforms: in the time of the plan, ended like every wait, on both back ends."""

import pytest
from systems import ONE_BACKEND

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.repl.session import Session


@pytest.fixture(params=ONE_BACKEND)
def session(request):
    made = Session(time="virtual", turtlesim=False, backend=request.param)
    made.package = "CRAM-USER"
    yield made
    kernel.stop()
    PACKAGE.value = COMMON_LISP_USER


def test_a_lookup_waits_until_the_transform_comes(lisp):
    assert lisp("""(let ((start (roslisp:ros-time)))
                     (cpl:top-level
                       (cpl:par
                         (cpl:seq (cpl:sleep 2.5) (told "map" "base" 7.0 1))
                         (cpl:seq (assert (= 1 (x (translation (lookup-transform *tf* "map" "base" :timeout 10)))))
                                  (assert (< 2.4 (- (roslisp:ros-time) start) 2.6))
                                  :there))))""")


def test_a_lookup_for_a_time_to_come_waits_for_its_second(lisp):
    # In the original a second without entries is a failed assertion, which ends the wait.
    lisp('(told "map" "base" 1.0 1)')
    assert (
        lisp("""(cpl:top-level
                     (cpl:pursue
                       (x (translation (lookup-transform *tf* "map" "base" :time 3.5 :timeout 10)))
                       (cpl:seq (cpl:sleep 1) (told "map" "base" 3.0 3) (cpl:sleep 1) (told "map" "base" 4.0 4) (cpl:sleep 1) nil)))""")
        == "3.5d0"
    )


def test_a_wait_keeps_its_time(lisp):
    text = '(cpl:top-level (list (wait-for-transform *tf* :target-frame "map" :source-frame "base" :timeout 3) (roslisp:ros-time)))'
    before = lisp.value("(roslisp:ros-time)")
    answer, after = lisp.value(text)
    assert answer is None and after - before == pytest.approx(3, abs=1e-6)
    lisp('(told "map" "base" 1.0 1)')
    answer, later = lisp.value(text)
    assert answer is True and later == after


def test_a_wait_for_ever_is_evaporated(lisp):
    assert (
        lisp("""(let ((cleaned nil))
                     (cpl:top-level
                       (cpl:pursue
                         (unwind-protect (wait-for-transform *tf* :target-frame "map" :source-frame "base") (setf cleaned t))
                         (cpl:sleep 4)))
                     cleaned)""")
        == "T"
    )
    assert lisp.value("*tf*").waiting._tasks == []


def test_a_wait_for_ever_of_which_nobody_can_know_the_end_is_told(lisp):
    text = lisp.error('(wait-for-transform *tf* :target-frame "map" :source-frame "base")')
    assert "a transform from base to map" in text


def test_callbacks_that_are_suppressed_wake_nobody(lisp):
    assert lisp("""(cpl:top-level
                     (cpl:par
                       (cpl:seq (wait-for-transform *tf* :target-frame "map" :source-frame "base") (setf *tf* (cpl:value 1)))
                       (cpl:seq (cpl:sleep 1)
                                (set-transform *tf* (at "map" "base" 1.0 1) :suppress-callbacks t)
                                (cpl:sleep 1)
                                (assert (typep *tf* 'transformer))
                                (execute-changed-callbacks *tf*)
                                (cpl:sleep 0.1)
                                (assert (eql *tf* 1)))))""")
