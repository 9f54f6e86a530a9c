"""The clocks of projections: projection-and-events.md A2."""

import pytest

CLOCKS = """
(defvar *linear* (make-instance 'linear-clock))
(defvar *ordered* (make-instance 'partially-ordered-clock))
(defun waits (&rest durations)
  (dolist (duration durations) (clock-wait *ordered* duration))
  (note (clock-time *ordered*)))
"""


@pytest.fixture
def clocks(lisp):
    lisp(CLOCKS)
    return lisp


@pytest.mark.law("projection-and-events", 10)
def test_a_linear_clock_advances_by_exactly_the_duration(clocks):
    clocks("(note (clock-time *linear*) (clock-wait *linear* 5) (clock-wait *linear* 1/2) (clock-time *linear*))")
    assert clocks("(notes)") == "((0 5 11/2 11/2))"
    assert clocks("(clock-wait (make-instance 'linear-clock :initial-time 2.0d0) 3)") == "5.0d0"
    assert clocks("(cut:current-timestamp)") == "0.0d0"


@pytest.mark.law("projection-and-events", 11)
def test_parallel_waits_on_a_partially_ordered_clock_overlap(clocks):
    clocks("(top-level (par (waits 5) (waits 10)))")
    assert clocks("(list (notes) (clock-time *ordered*))") == "((5 10) 10)"
    assert clocks("(list (<= (cut:current-timestamp) 0.2d0) (clock-wait *ordered* 1))") == "(T NIL)"


def test_waits_one_after_the_other_add_up_beside_a_long_one(clocks):
    clocks("(top-level (par (waits 5 2 1) (waits 10)))")
    times = clocks("(notes)")
    assert times in ("(8 10)", "(10 10)") and clocks("(clock-time *ordered*)") == "10"


def test_the_time_of_a_partially_ordered_clock_passes_in_steps_of_the_kernels_time(clocks):
    clocks("(setf *ordered* (make-instance 'partially-ordered-clock :initial-time 1 :increment-delay 2)) (top-level (waits 5))")
    assert clocks("(list (notes) (cut:current-timestamp))") == "((6) 2.0d0)"


@pytest.mark.law("projection-and-events", 12, 13)
def test_a_disabled_clock_lets_no_wait_end(clocks):
    clocks("""(top-level
                (par (progn (waits 5) (note (cut:current-timestamp)))
                     (with-partially-ordered-clock-disabled *ordered*
                       (note (partially-ordered-clock-enabled *ordered*)) (sleep 7) (note :enabled))))
              (note (partially-ordered-clock-enabled *ordered*))""")
    assert clocks("(notes)") == "(NIL :ENABLED 5 7.0d0 T)"


@pytest.mark.law("projection-and-events", 12)
def test_a_clock_is_disabled_until_the_last_activation_of_one_form_has_ended(clocks):
    clocks("""(defun disable (times) (when (plusp times) (with-partially-ordered-clock-disabled *ordered* (disable (1- times))
                                                           (note times (partially-ordered-clock-enabled *ordered*)))))
              (disable 2)
              (defun disable-for (seconds) (with-partially-ordered-clock-disabled *ordered* (sleep seconds)))
              (top-level (par (disable-for 1) (disable-for 4) (waits 2)))
              (note (> (cut:current-timestamp) 4))""")
    assert clocks("(notes)") == "((1 NIL) (2 NIL) 2 T)"


def test_a_form_that_disables_a_clock_and_is_evaporated_enables_it(clocks):
    clocks("""(top-level (pursue (sleep 1) (with-partially-ordered-clock-disabled *ordered* (sleep 100))))
              (note (partially-ordered-clock-enabled *ordered*)) (top-level (waits 2))""")
    assert clocks("(notes)") == "(T 2)"


def test_a_wait_that_is_evaporated_is_forgotten(clocks):
    clocks("""(top-level (with-partially-ordered-clock-disabled *ordered* (pursue (sleep 1) (waits 3))))
              (top-level (waits 10))""")
    assert clocks("(notes)") == "(10)"


@pytest.mark.law("projection-and-events", 14)
def test_a_wait_of_zero_returns_at_once_also_on_a_disabled_clock(clocks):
    assert clocks("(with-partially-ordered-clock-disabled *ordered* (clock-wait *ordered* 0)) (cut:current-timestamp)") == "0.0d0"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("duration", ["-1", ":soon", "#c(1 2)"])
@pytest.mark.parametrize("clock", ["*linear*", "*ordered*"])
def test_a_duration_is_a_real_number_not_below_zero(clocks, clock, duration):
    told = clocks.error(f"(clock-wait {clock} {duration})")
    assert told.startswith(f"The value {duration.upper()} is not of type (REAL 0)".replace("#C", "#C"))
    assert told.endswith("(A clock waits for a duration: a real number, not below 0.)")
    assert clocks("(list (clock-time *linear*) (clock-time *ordered*))") == "(0 0)"


def test_users_may_make_clocks_of_their_own(clocks):
    clocks("""(defclass fast-clock (linear-clock) ((factor :initarg :factor :reader factor)))
              (defmethod clock-wait :around ((clock fast-clock) duration) (call-next-method clock (* duration (factor clock))))""")
    assert clocks("(clock-wait (make-instance 'fast-clock :factor 10 :initial-time 1) 2)") == "21"
