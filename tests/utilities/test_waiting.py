"""Locks, condition variables, semaphores, mailboxes, queues, barriers: who is served when, and what becomes of those who wait."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition


@pytest.mark.parametrize(
    ("form", "values"),
    [
        (
            "(let ((s (cut:make-semaphore :count 2)))"
            " (list (cut:wait-on-semaphore s) (cut:try-semaphore s) (cut:try-semaphore s) (cut:signal-semaphore s 2) (cut:semaphore-count s)"
            " (cut:wait-on-semaphore s :n 5 :timeout 1) (cut:semaphore-count s) (cut:semaphore-name s)))",
            "(1 0 NIL NIL 2 NIL 2 NIL)",
        ),
        (
            "(let ((q (cut:make-queue :name :q :initial-contents '(1 2))))"
            " (list (cut:enqueue 3 q) (multiple-value-list (cut:dequeue q)) (cut:list-queue-contents q) (cut:queue-count q) (cut:queue-empty-p q)"
            " (cut:queue-name q) (cut:queuep q) (cut:queuep 1) (typep q 'cut:queue)))",
            "(3 (1 T) (2 3) 2 NIL :Q T NIL T)",
        ),
        ("(cut:dequeue (cut:make-queue))", "NIL NIL"),
        (
            '(let ((m (cut:make-mailbox :name "mb"))) (dotimes (i 4) (cut:send-message m i))'
            " (list (multiple-value-list (cut:receive-message m)) (cut:list-mailbox-messages m) (cut:mailbox-count m)"
            " (cut:receive-pending-messages m 2) (cut:receive-pending-messages m) (cut:mailbox-empty-p m) (cut:mailbox-name m) (cut:mailboxp m)"
            " (multiple-value-list (cut:receive-message-no-hang m)) (multiple-value-list (cut:receive-message m :timeout 1))))",
            '((0 T) (1 2 3) 3 (1 2) (3) T "mb" T (NIL NIL) (NIL NIL))',
        ),
        ('(let ((l (cut:make-recursive-lock))) (cut:with-lock-held (l) (cut:with-lock-held (l :whostate "x") (values 1 2))))', "1 2"),
        (
            "(let ((c (cut:make-condition-variable))) (list (cut:condition-variable-wait-with-timeout c 2)"
            " (cut:condition-variable-signal c) (cut:condition-variable-broadcast c)))",
            "(NIL NIL NIL)",
        ),
        ("(typep (cut:make-synchronization-barrier 2 :recyclable t) 'cut:cyclic-barrier)", "T"),
    ],
)
def test_values(lisp, form, values):
    assert lisp(form) == values


@pytest.mark.parametrize(
    ("form", "text"),
    [
        ("(let ((l (cut:make-lock))) (cut:with-lock-held (l) (cut:with-lock-held (l) 1)))", "Recursive lock attempt #<LOCK"),
        ("(cut:signal-semaphore (cut:make-semaphore) 0)", "The value\n  0\nis not of type\n  (INTEGER 1)"),
        ("(cut:wait-on-semaphore 3)", "The value\n  3\nis not of type\n  CRAM-UTILITIES:SEMAPHORE"),
        ("(cut:make-semaphore :count -1)", "The value\n  -1\nis not of type\n  UNSIGNED-BYTE"),
        ("(cut:receive-message :m)", "The value\n  :M\nis not of type\n  CRAM-UTILITIES:MAILBOX"),
        ("(cut:with-hash-table-locked ((make-hash-table)) 1)", "The value\n  #<HASH-TABLE"),
        ("(let ((b (cut:make-synchronization-barrier 1))) (cut:enter-barrier b) (cut:enter-barrier b))", "The barrier #<BARRIER 0/1 {"),
    ],
)
def test_what_is_wrong(lisp, form, text):
    with pytest.raises(Condition) as caught:
        lisp(form)
    assert caught.value.report().startswith(text)


def test_a_lock_that_its_holder_takes_again_names_the_kind_that_allows_it(lisp):
    with pytest.raises(Condition) as caught:
        lisp("(let ((l (cut:make-lock))) (cut:with-lock-held (l) (cut:with-lock-held (l) 1)))")
    assert caught.value.hint == "This task has the lock already. One that its holder may take again is made with MAKE-RECURSIVE-LOCK."


def test_a_lock_is_served_in_order_and_nobody_overtakes(lisp):
    assert (
        lisp("""(let ((l (cut:make-lock)) (log nil))
      (flet ((work (name) (lambda () (loop repeat 2 do (cut:with-lock-held (l) (sleep 1) (push name log))))))
        (mapc #'cut:join-thread (list (cut:spawn-thread "a" (work :a)) (cut:spawn-thread "b" (work :b)) (cut:spawn-thread "c" (work :c))))
        (reverse log)))""")
        == "(:A :B :C :A :B :C)"
    )
    assert kernel.now() == 6


def test_an_evaporated_task_gives_its_lock_up_and_leaves_the_line(lisp):
    assert (
        lisp("""(let ((l (cut:make-lock)) (log nil))
      (top-level
        (par (pursue (cut:with-lock-held (l) (sleep 9)) (sleep 3))
             (pursue (cut:with-lock-held (l) (push :never log)) (sleep 1))
             (seq (sleep 2) (cut:with-lock-held (l) (push :got-it log)))))
      log)""")
        == "(:GOT-IT)"
    )
    assert kernel.now() == 3


def test_a_lock_that_was_handed_to_a_task_that_dies_before_it_runs_goes_to_the_next(lisp):
    assert (
        lisp("""(let ((l (cut:make-lock)) (log nil) dying)
      (cut:spawn-thread "holder" (lambda () (cut:with-lock-held (l) (sleep 1)) (cut:kill-thread dying)))
      (sleep 0.1)
      (setf dying (cut:spawn-thread "dying" (lambda () (cut:with-lock-held (l) (push :never log)))))
      (sleep 0.1)
      (cut:with-lock-held (l) (push :next log))
      log)""")
        == "(:NEXT)"
    )


def test_a_unit_of_a_semaphore_and_a_message_are_not_lost_with_a_task_that_dies_before_it_runs(lisp):
    assert (
        lisp("""(let ((s (cut:make-semaphore)) (m (cut:make-mailbox)))
      (let ((a (cut:spawn-thread "a" (lambda () (cut:wait-on-semaphore s))))
            (b (cut:spawn-thread "b" (lambda () (cut:receive-message m)))))
        (sleep 1)
        (cut:signal-semaphore s)
        (cut:send-message m :hello)
        (cut:kill-thread a) (cut:kill-thread b)
        (cut:join-thread a :on-failure nil) (cut:join-thread b :on-failure nil)
        (list (cut:semaphore-count s) (cut:list-mailbox-messages m))))""")
        == "(1 (:HELLO))"
    )


def test_who_wants_more_units_is_not_overtaken_by_who_wants_fewer(lisp):
    assert (
        lisp("""(let ((s (cut:make-semaphore)) (log nil))
      (let ((threads (list (cut:spawn-thread "two" (lambda () (cut:wait-on-semaphore s :n 2) (push 2 log)))
                           (cut:spawn-thread "one" (lambda () (cut:wait-on-semaphore s) (push 1 log))))))
        (loop repeat 3 do (sleep 1) (cut:signal-semaphore s))
        (mapc #'cut:join-thread threads)
        (reverse log)))""")
        == "(2 1)"
    )


def test_messages_arrive_in_the_order_in_which_they_were_sent(lisp):
    assert (
        lisp("""(let ((m (cut:make-mailbox)))
      (cut:spawn-thread "sender" (lambda () (dotimes (i 5) (sleep 1) (cut:send-message m i))))
      (loop repeat 5 collect (cut:receive-message m)))""")
        == "(0 1 2 3 4)"
    )


def test_a_condition_variable_frees_its_lock_while_its_task_waits_and_gives_it_back(lisp):
    assert (
        lisp("""(let* ((l (cut:make-lock)) (c (cut:make-condition-variable :lock l)) (ready nil) (log nil))
      (cut:spawn-thread "setter" (lambda () (sleep 1) (cut:with-lock-held (l) (setf ready t) (cut:condition-variable-signal c) (sleep 1))))
      (cut:with-lock-held (l)
        (loop until ready do (cut:condition-variable-wait c))
        (push (format nil "~,1f" (/ (get-internal-real-time) internal-time-units-per-second)) log))
      log)""")
        == '("2.0")'
    )


def test_an_evaporated_task_has_the_lock_of_its_condition_variable_in_its_cleanup(lisp):
    assert (
        lisp("""(let* ((l (cut:make-lock :name "l")) (c (cut:make-condition-variable :lock l)) (shown nil))
      (top-level (pursue (cut:with-lock-held (l) (unwind-protect (cut:condition-variable-wait c) (setf shown (princ-to-string l))))
                         (sleep 1)))
      (list (search "taken" shown) (search "free" (princ-to-string l))))""")
        == "(11 11)"
    )


def test_other_tasks_wait_at_a_locked_hash_table(lisp):
    assert (
        lisp("""(let ((h (cut:make-synchronized-hash-table)) (seen nil))
      (dotimes (i 3) (setf (gethash i h) i))
      (cut:spawn-thread "writer" (lambda () (sleep 1) (setf (gethash 7 h) 7)))
      (cut:with-hash-table-locked (h) (maphash (lambda (k v) (declare (ignore v)) (sleep 1) (push k seen)) h))
      (sleep 1)
      (list seen (hash-table-count h)))""")
        == "((2 1 0) 4)"
    )


def test_a_barrier_opens_when_all_have_come_and_a_cyclic_one_closes_again(lisp):
    assert (
        lisp("""(let ((b (cut:make-synchronization-barrier 3 :recyclable t)) (log nil))
      (mapc #'cut:join-thread
            (loop for i from 1 to 3 collect (let ((i i)) (cut:spawn-thread nil
              (lambda () (loop repeat 2 do (sleep i) (cut:enter-barrier b)
                                            (push (round (get-internal-real-time) internal-time-units-per-second) log)))))))
      (sort log #'<))""")
        == "(3 3 3 6 6 6)"
    )


def test_who_waits_at_a_broken_barrier_hears_of_it_and_an_evaporated_one_does_not_count(lisp):
    assert (
        lisp("""(cut:with-synchronization-barrier (b 2)
      (let ((waiting (cut:spawn-thread "w" (lambda () (cut:enter-barrier b :if-broken :broken)))))
        (sleep 1) (cut:break-barrier b)
        (list (cut:join-thread waiting) (cut:enter-barrier b :if-broken :too-late))))""")
        == "(:BROKEN :TOO-LATE)"
    )
    assert (
        lisp("""(let ((b (cut:make-synchronization-barrier 2)))
      (top-level (pursue (cut:enter-barrier b) (sleep 1)))
      (let ((late (cut:spawn-thread "late" (lambda () (cut:enter-barrier b)))))
        (list (cut:join-thread late :timeout 1) (cut:decrement-barrier-threshold b) (cut:join-thread late))))""")
        == "(:TIMEOUT 1 T)"
    )


def test_a_barrier_is_raised_and_reset(lisp):
    assert (
        lisp("""(let ((b (cut:make-synchronization-barrier 1 :recyclable t)))
      (list (cut:increment-barrier-threshold b 2)
            (let ((w (cut:spawn-thread "w" (lambda () (cut:enter-barrier b :if-broken :reset)))))
              (sleep 1) (cut:reset-cyclic-barrier b) (cut:join-thread w))
            (progn (cut:decrement-barrier-threshold b 2) (cut:enter-barrier b))))""")
        == "(3 :RESET T)"
    )


def test_waiting_for_ever_is_a_deadlock_that_says_for_what(lisp):
    with pytest.raises(kernel.Deadlock) as caught:
        lisp("""(top-level (let ((l (cut:make-lock :name "l")) (s (cut:make-semaphore :name "s")) (m (cut:make-mailbox)))
          (par (cut:with-lock-held (l) (cut:wait-on-semaphore s :n 2)) (cut:with-lock-held (l) 1) (cut:receive-message m)
               (cut:enter-barrier (cut:make-synchronization-barrier 3 :name "b"))
               (cut:condition-variable-wait (cut:make-condition-variable))
               (cut:join-thread (cut:spawn-thread "w" (lambda () (wait-for (make-fluent))))))))""")
    text = str(caught.value)
    for reason in (
        "2 of the semaphore s",
        "the lock l, which [PAR-CHILD-#1/6]-",
        "a message in the mailbox",
        "2 more at the barrier b",
        "the signal of a condition variable",
        "the end of the thread w",
    ):
        assert f"waits for {reason}" in text


def test_a_task_is_suspended_while_it_waits_for_a_semaphore(lisp):
    assert (
        lisp("""(let ((s (cut:make-semaphore)) (log nil))
      (top-level (with-tags (par
        (:tag taker (cut:wait-on-semaphore s) (push (round (get-internal-real-time) internal-time-units-per-second) log))
        (seq (sleep 1) (with-task-suspended (taker) (cut:signal-semaphore s) (sleep 2))))))
      log)""")
        == "(3)"
    )


@pytest.mark.parametrize("way", ["(cut:wait-on-semaphore s :n 3 :timeout 2)", "(pursue (cut:wait-on-semaphore s :n 3) (sleep 2))"])
def test_who_leaves_the_front_of_the_line_wanting_much_lets_those_through_who_want_less(lisp, way):
    assert (
        lisp(f"""(let ((s (cut:make-semaphore :count 1)))
      (top-level (par {way} (seq (sleep 1) (cut:wait-on-semaphore s))))
      (cut:semaphore-count s))""")
        == "0"
    )
    assert kernel.now() == 2


def test_who_could_not_get_its_lock_back_does_not_give_up_that_of_another(lisp):
    """The second request ends the wait for the lock, in the cleanup of the wait for the condition variable."""
    assert (
        lisp("""(let* ((l (cut:make-lock)) (c (cut:make-condition-variable :lock l)) (log nil))
      (top-level (with-tags (par
        (:tag waiter (cut:with-lock-held (l) (cut:condition-variable-wait c)))
        (seq (sleep 1) (cut:with-lock-held (l) (push :taken log) (sleep 9) (push :given-up log)))
        (seq (sleep 2) (evaporate waiter :sync nil) (sleep 1) (evaporate waiter))
        (seq (sleep 4) (cut:with-lock-held (l) (push :next log))))))
      (reverse log))""")
        == "(:TAKEN :GIVEN-UP :NEXT)"
    )
