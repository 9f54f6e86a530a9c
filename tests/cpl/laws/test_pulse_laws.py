"""Pulse fluents, ``fl-value-changed``, waiting and ``whenever``: invariants 23 to 37 of cpl.md section 16."""

import pytest

from cramhy_runtime import kernel

MODES = [":never", ":once", ":always"]


@pytest.fixture
def reads(lisp):
    """The first reads of a pulse fluent of ``mode`` that was made after ``before`` pulses, when ``after`` more have come."""

    def read(mode, before, after, count, reader="value"):
        return lisp(f"""(let ((f (make-fluent)))
                          (dotimes (i {before}) (pulse f))
                          (let ((p (pulsed f :handle-missed-pulses {mode})))
                            (dotimes (i {after}) (pulse f))
                            (loop repeat {count} collect ({reader} p))))""")

    return read


@pytest.mark.law(23)
@pytest.mark.parametrize("mode", MODES)
def test_peeking_changes_no_later_read(lisp, mode):
    assert (
        lisp(f"""(let* ((f (make-fluent)) (p (pulsed f :handle-missed-pulses {mode})))
                      (pulse f)
                      (list (peek-value p) (peek-value p) (peek-value p) (value p) (peek-value p) (value p)))""")
        == "(T T T T NIL NIL)"
    )


@pytest.mark.law(23)
def test_peeking_a_net_consumes_nothing_of_all_that_its_function_reads(lisp):
    assert (
        lisp("""(let* ((f (make-fluent :value 1)) (hidden (pulsed f)) (seen (pulsed f)) (changed (fl-value-changed f))
                          (net (fl-funcall (lambda (p) (list p (value hidden) (value (not changed)))) seen)))
                     (setf (value f) 2)
                     (list (peek-value net) (peek-value net) (value net) (value net)))
                """)
        == "((T T NIL) (T T NIL) (T T NIL) (NIL NIL T))"
    )


@pytest.mark.soak(all_but=5)
@pytest.mark.law(24, 25)
@pytest.mark.parametrize(
    "mode, before, after, expected",
    [
        (":never", 0, 0, "(NIL NIL NIL NIL)"), (":once", 0, 0, "(NIL NIL NIL NIL)"), (":always", 0, 0, "(NIL NIL NIL NIL)"),
        (":never", 0, 3, "(T NIL NIL NIL)"), (":once", 0, 3, "(T NIL NIL NIL)"), (":always", 0, 3, "(T T T NIL)"),
        (":never", 2, 0, "(NIL NIL NIL NIL)"), (":once", 2, 0, "(T NIL NIL NIL)"), (":always", 2, 0, "(T T NIL NIL)"),
        (":never", 2, 1, "(T NIL NIL NIL)"), (":once", 2, 1, "(T NIL NIL NIL)"), (":always", 2, 1, "(T T T NIL)"),
    ],
)  # fmt: skip
def test_how_many_reads_are_true_before_and_after_the_creation(reads, mode, before, after, expected):
    assert reads(mode, before, after, 4) == expected


@pytest.mark.law(26)
def test_consumers_with_pulse_fluents_of_their_own_count_all_pulses(lisp):
    assert (
        lisp("""(let* ((f (make-fluent :value 0)) (done (make-fluent)) (counts (list 0 0 0)))
                     (top-level
                       (pursue
                         (par-loop (i '(0 1 2))
                           (whenever ((pulsed f :handle-missed-pulses :always))
                             (incf (nth i counts)) (sleep (* 0.3 i))))
                         (progn (dotimes (i 7) (setf (value f) (1+ i)) (sleep 0.1)) (sleep 100))))
                     counts)""")
        == "(7 7 7)"
    )


@pytest.mark.law(27)
@pytest.mark.parametrize("mode, expected", [(":always", 5), (":once", 1)])
def test_consumers_that_share_a_pulse_fluent_consume_each_pulse_once(lisp, mode, expected):
    assert lisp(f"""(let* ((f (make-fluent)) (n 0) (p (pulsed f :handle-missed-pulses {mode})))
                      (top-level
                        (pursue (par-loop (i '(1 2 3 4 5 6 7)) (wait-for p) (incf n))
                                (progn (sleep 1) (dotimes (i 5) (pulse f)) (sleep 1))))
                      n)""") == str(expected)


@pytest.mark.law(28)
def test_with_once_every_consumer_sees_the_last_value_however_many_pulses_collapsed(lisp):
    assert (
        lisp("""(let* ((f (make-fluent :value 0)) (last (list nil nil nil)))
                     (top-level
                       (pursue
                         (par-loop (i '(0 1 2))
                           (whenever ((pulsed f)) (sleep (* 0.7 i)) (setf (nth i last) (value f))))
                         (progn (dotimes (i 20) (setf (value f) (1+ i)) (sleep 0.1)) (sleep 100))))
                     last)""")
        == "(20 20 20)"
    )


@pytest.mark.law(29, 30)
def test_value_changed_is_true_once_after_a_change_and_never_for_a_mere_pulse(lisp):
    assert (
        lisp("""(let* ((f (make-fluent :value 1)) (changed (fl-value-changed f)))
                     (list (value changed) (progn (pulse f) (value changed))
                           (progn (setf (value f) 2) (peek-value changed)) (value changed) (value changed)
                           (progn (setf (value f) 3) (setf (value f) 2) (value changed))))""")
        == "(NIL NIL T T NIL NIL)"
    )


@pytest.mark.law(29)
def test_value_changed_goes_on_seeing_through_its_key(lisp):
    """Repaired: the original compares with the whole value after the first change."""
    assert (
        lisp("""(let* ((f (make-fluent :value (list 1 :a))) (changed (fl-value-changed f :key #'first :test #'=)))
                     (flet ((look (new) (setf (value f) new) (list (value changed) (value changed))))
                       (list (look '(1 :b)) (look '(2 :b)) (look '(2 :c)) (look '(3 :c)))))
                """)
        == "((NIL NIL) (T NIL) (NIL NIL) (T NIL))"
    )


@pytest.mark.law(30)
def test_a_mere_pulse_releases_no_wait_for_a_change(lisp):
    assert (
        lisp("""(let ((f (make-fluent :value 1)))
                     (top-level (par (wait-for (fl-value-changed f) :timeout 5) (dotimes (i 8) (sleep 0.5) (pulse f)))))""")
        == "NIL"
    )
    assert kernel.now() == 5


@pytest.mark.law(31)
def test_a_wait_gives_the_true_value_at_once_and_does_not_end_by_pulses_of_nil(lisp):
    assert (
        lisp("""(let ((f (make-fluent)))
                     (list (wait-for (make-fluent :value 0)) (wait-for (make-fluent :value "")) (wait-for (make-fluent :value 'x))
                           (top-level (par (wait-for f :timeout 9) (dotimes (i 5) (sleep 1) (pulse f))))))""")
        == '(0 "" X NIL)'
    )
    assert kernel.now() == 9


@pytest.mark.law(32)
def test_a_true_value_releases_all_who_wait_for_it_or_for_a_net_that_became_true(lisp):
    assert (
        lisp("""(let* ((f (make-fluent :value nil)) (net (not (not f))) (n 0))
                     (top-level (par (par-loop (i '(1 2 3)) (wait-for f) (incf n))
                                     (par-loop (i '(1 2 3)) (wait-for net) (incf n))
                                     (par-loop (i '(1 2 3)) (wait-for (eq f :go)) (incf n))
                                     (progn (sleep 1) (assert (= n 0)) (setf (value f) :go))))
                     n)""")
        == "9"
    )


@pytest.mark.law(33)
@pytest.mark.parametrize("timeout, seconds", [("2", 2), ("0.25", 0.25), ("1/2", 0.5), ("3d0", 3)])
def test_a_timed_wait_for_what_never_comes_takes_its_time(lisp, timeout, seconds):
    assert lisp(f"(top-level (wait-for (make-fluent) :timeout {timeout}))") == "NIL"
    assert kernel.now() == seconds


@pytest.mark.law(33)
def test_a_timed_wait_keeps_its_time_though_the_fluent_pulses(lisp):
    """Repaired: in the original each pulse shortens it."""
    assert lisp("(let ((f (make-fluent))) (top-level (par (wait-for f :timeout 1.0) (dotimes (i 9) (sleep 0.1) (pulse f)))))") == "NIL"
    assert kernel.now() == 1


@pytest.mark.law(34)
@pytest.mark.parametrize("timeout", ["0", "-1", "-1/2", "0.0"])
def test_a_wait_without_time_only_looks(lisp, timeout):
    assert (
        lisp(f"""(list (wait-for (make-fluent :value 3) :timeout {timeout}) (wait-for (make-fluent) :timeout {timeout})
                          (top-level (wait-for (make-fluent) :timeout {timeout})))""")
        == "(3 NIL NIL)"
    )
    assert kernel.now() == 0


@pytest.mark.law(35)
def test_whenever_runs_at_once_for_a_true_value_and_not_at_all_for_nil(lisp):
    assert (
        lisp("""(let ((runs 0) (f (make-fluent)))
                     (list (whenever ((make-fluent :value 4)) (when (= (incf runs) 3) (return runs)))
                           (progn (top-level (pursue (whenever (f) (setf runs :wrong)) (dotimes (i 5) (sleep 1) (pulse f)))) runs)))
                """)
        == "(3 3)"
    )


@pytest.mark.law(36)
def test_whenever_over_always_runs_once_per_pulse_though_its_body_is_slow(lisp):
    assert (
        lisp("""(let* ((f (make-fluent :value 0)) (seen nil) (p (pulsed f :handle-missed-pulses :always)))
                     (top-level (pursue (whenever (p) (sleep 1) (push (value f) seen))
                                        (progn (dotimes (i 5) (setf (value f) (1+ i))) (sleep 100))))
                     seen)""")
        == "(5 5 5 5 5)"
    )


@pytest.mark.law(37)
def test_return_ends_whenever_with_its_values(lisp):
    assert (
        lisp("""(let ((n 0))
                     (multiple-value-list
                       (whenever ((make-fluent :value 1) :wait-status :asleep) (when (= (incf n) 4) (return (values n :done))))))
                """)
        == "(4 :DONE)"
    )


def test_a_timed_wait_can_be_evaporated_and_suspended(lisp):
    """Repaired: in the original it reacts to nothing until its time is over."""
    lisp("(top-level (pursue (wait-for (make-fluent) :timeout 100) (sleep 1)))")
    assert kernel.now() == 1
    assert (
        lisp("""(let ((f (make-fluent)) (answer nil))
                     (top-level
                       (with-tags
                         (par (:tag waiting (setf answer (wait-for f :timeout 10)))
                              (progn (sleep 1)
                                     (with-task-suspended (waiting) (setf (value f) :missed) (setf (value f) nil) (sleep 2)
                                                                    (setf (value f) :seen) (sleep 20))))))
                     answer)""")
        == ":SEEN"
    )
    assert kernel.now() == 24
