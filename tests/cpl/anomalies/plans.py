"""Plans that together use every operator of the language; small, with a way out of every wait.

Each says what it gives when nothing happens (``value``) and what else it may give when a task of it is evaporated (``evaporated``) or
suspended for a while (``suspended``), as printed. A plan that is failed fails with the injected failure, or copes, which gives one of
the same results; ``failed`` lists what else. ``free``: printed results that may come of another seed.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Plan:
    name: str
    text: str  # or a function
    value: str
    evaporated: tuple = ()
    suspended: tuple = ()
    failed: tuple = ()
    free: tuple = ()


PLANS = [
    Plan(
        "seq",
        """
        (top-level
          (guarded outer
            (seq (guarded one (sleep 0.1) 1)
                 (guarded-slowly two 0.1 (sleep 0.1) 2))))
        """,
        "2",
    ),
    Plan(
        "par",
        """
        (top-level
          (guarded outer
            (par (guarded one (sleep 0.1) 1)
                 (guarded-slowly two 0.1
                   (par (guarded inner-one (sleep 0.1) 2)
                        (guarded-slowly inner-two 0.1 (sleep 0.1) 3)
                        (guarded inner-three (sleep 0.2) 4))))))
        """,
        "1",
        evaporated=("no values",),
    ),
    Plan(
        "pursue",
        """
        (top-level
          (guarded outer
            (pursue (guarded-slowly slow 0.2 (sleep 10) 1)
                    (guarded fast (sleep 0.2) 2)
                    (guarded-slowly nested 0.1
                      (pursue (guarded-slowly deep 0.1 (sleep 5) 3)
                              (guarded deeper (sleep 6) 4))))))
        """,
        "2",
        evaporated=("no values",),
    ),
    Plan(
        "try-all",
        """
        (top-level
          (guarded outer
            (try-all (guarded-slowly failing 0.1 (sleep 0.1) (fail "first"))
                     (guarded good (sleep 0.2) 2)
                     (guarded-slowly as-good 0.1 (sleep 0.2) 3)
                     (guarded-slowly late 0.1 (sleep 1) 4))))
        """,
        "2",
        evaporated=("no values",),
        failed=("3",),
    ),
    Plan(
        "try-in-order",
        """
        (top-level
          (guarded outer
            (try-in-order (guarded failing (sleep 0.1) (fail "first"))
                          (guarded-slowly also 0.1 (par (sleep 0.1) (sleep 0.1) (progn (sleep 0.1) (fail "second"))))
                          (guarded good (sleep 0.1) 3)
                          4)))
        """,
        "3",
        evaporated=("NIL",),
        failed=("4",),
    ),
    Plan(
        "try-each-in-order",
        """
        (top-level
          (guarded outer
            (try-each-in-order (n '(1 2 3))
              (guarded each (sleep 0.1) (if (= n 2) (* 10 n) (fail "not ~a" n))))))
        """,
        "20",
    ),
    Plan(
        "par-loop",
        """
        (top-level
          (guarded outer
            (let ((sum 0))
              (par-loop (n '(1 2 3))
                (guarded-slowly each 0.1 (sleep 0.1) (setf sum (+ sum n))))
              sum)))
        """,
        "6",
        evaporated=("3", "4", "5"),
    ),
    Plan(
        "partial-order",
        """
        (top-level
          (let ((log nil))
            (guarded outer
              (with-tags
                (partial-order ((:tag a (guarded a (sleep 0.2) (push :a log)))
                                (:tag b (guarded b (sleep 0.1) (push :b log)))
                                (:tag c (guarded-slowly c 0.1 (sleep 0.1) (push :c log))))
                  (:order b a)
                  (:order a c))))
            (reverse log)))
        """,
        "(:B :A :C)",
        evaporated=("(:B :C)", "(:A :C)", "(:B :A)"),
    ),
    Plan(
        "tags-and-suspension",
        """
        (top-level
          (let ((log nil))
            (guarded outer
              (with-tags
                (par (:tag walk
                       (guarded-slowly walk 0.1
                         (dotimes (step 4) (sleep 0.1) (push step log))))
                     (guarded stop
                       (sleep 0.1)
                       (with-task-suspended (walk)
                         (guarded while-suspended (push :stopped log) (sleep 1) (push :on log)))))))
            (reverse log)))
        """,
        "(0 :STOPPED :ON 1 2 3)",
        evaporated=("(0 1 2 3)", "(:STOPPED*)", "(0 :STOPPED*)"),
        suspended=("(*:STOPPED*:ON*)",),
        free=("(:STOPPED :ON 0 1 2 3)",),
    ),
    Plan(
        "with-parallel-childs",
        """
        (top-level
          (guarded outer
            (cpl-impl::with-parallel-childs nil (running done failed)
                ((guarded-slowly one 0.1 (sleep 0.1) 1)
                 (guarded two (sleep 0.2) 2)
                 (guarded-slowly three 0.1 (sleep 5) 3))
              (when failed (fail (result (first failed))))
              (when (>= (length done) 2) (return (length running))))))
        """,
        "1",
        evaporated=("0",),
    ),
    Plan(
        "with-task",
        """
        (top-level
          (guarded outer
            (cpl-impl::with-task (:name "INNER")
              (guarded-slowly inner 0.1
                (sleep 0.1)
                (cpl-impl::with-task () (guarded innermost (sleep 0.1) 7))))))
        """,
        "7",
        evaporated=("no values",),
    ),
    Plan(
        "timeout-policy",
        """
        (top-level
          (guarded outer
            (with-failure-handling
                ((policy-check-condition-met (e) (declare (ignore e)) (return :timeout)))
              (with-policy timeout-policy (0.3)
                (guarded-slowly body 0.1 (par (sleep 10) (guarded branch (sleep 5))))))))
        """,
        ":TIMEOUT",
        evaporated=("no values",),
    ),
    Plan(
        "with-policy",
        """
        (define-policy anomaly-policy (limit)
          "Watches the time."
          (:init (cpl-impl::policy-setf 'start 0) (guarded init (sleep 0.1)) t)
          (:check
            (sleep 0.1)
            (cpl-impl::policy-setf 'start (+ 0.1 (cpl-impl::policy-get 'start)))
            (> (cpl-impl::policy-get 'start) limit))
          (:recover (guarded recover (sleep 0.1)))
          (:clean-up (guarded clean-up (sleep 0.1))))
        (top-level
          (guarded outer
            (with-failure-handling
                ((policy-check-condition-met (e) (declare (ignore e)) (return :met))
                 (policy-init-failed (e) (declare (ignore e)) (return :not-started)))
              (with-policy anomaly-policy (0.3)
                (guarded-slowly body 0.1 (par (sleep 10) (dotimes (n 9) (sleep 0.1))))))))
        """,
        ":MET",
        evaporated=("no values",),
    ),
    Plan(
        "failure-handling",
        """
        (top-level
          (guarded outer
            (with-retry-counters ((tries 2))
              (with-failure-handling
                  ((simple-plan-failure (e) (declare (ignore e))
                     (do-retry tries (guarded handler (sleep 0.1)) (retry))
                     (return :given-up)))
                (guarded-slowly body 0.1
                  (par (guarded branch (sleep 0.1) (sleep 1))
                       (guarded other (sleep 0.1))
                       (progn (sleep 0.1) (fail "again"))))))))
        """,
        ":GIVEN-UP",
        evaporated=("NIL",),
    ),
    Plan(
        "whenever-and-pulses",
        """
        (top-level
          (let ((bell (make-fluent :name 'bell :value nil)) (heard 0))
            (guarded outer
              (pursue
                (guarded-slowly listening 0.1
                  (whenever ((pulsed bell :handle-missed-pulses :always))
                    (setf heard (+ heard 1))
                    (when (>= heard 3) (return heard))))
                (guarded ringing
                  (dotimes (n 5) (sleep 0.1) (pulse bell))
                  (sleep 1)
                  :not-heard)))))
        """,
        "3",
        evaporated=("no values",),
    ),
    Plan(
        "wait-for-and-nets",
        """
        (top-level
          (let* ((x (make-fluent :name 'x :value 0)) (y (make-fluent :name 'y :value 10))
                 (near (fl-and (< x y) (> (+ x y) 12) (fl-funcall #'evenp x)))
                 (changed (fl-value-changed x :test #'eql)))
            (guarded outer
              (par (guarded moving (dotimes (n 5) (sleep 0.1) (setf (value x) n)) :moved)
                   (guarded-slowly waiting 0.1 (wait-for near :timeout 2) (value x))
                   (guarded-slowly in-vain 0.1 (wait-for (not (< x y)) :timeout 0.4))
                   (guarded changes (wait-for changed :timeout 2) (wait-for (pulsed y) :timeout 0.2) (value y))))))
        """,
        ":MOVED",
        evaporated=("no values",),
    ),
    Plan(
        "plan-functions",
        """
        (def-cram-function anomaly-step (n)
          (guarded-slowly step 0.1 (sleep 0.1) (* n n)))
        (def-cram-function anomaly-steps (n)
          (guarded steps
            (:tag first-step (anomaly-step n))
            (par (anomaly-step n) (anomaly-step (+ n 1)))))
        (def-top-level-cram-function anomaly-top ()
          (guarded outer (anomaly-steps 3)))
        (anomaly-top)
        """,
        "9",
        evaporated=("no values",),
    ),
    Plan(
        "goals",
        """
        (declare-goal anomaly-at (place) (declare (ignore place)) (sleep 0.1))
        (def-goal (anomaly-at door) (guarded door (sleep 0.1) (succeed :door)))
        (def-goal (anomaly-at ?where)
          (guarded-slowly where 0.1 (par (sleep 0.1) (sleep 0.1) (anomaly-at 'door)) (list :at ?where)))
        (top-level (guarded outer (anomaly-at 'table)))
        """,
        "(:AT TESTING-USER::TABLE)",
        evaporated=("no values",),
    ),
    Plan(
        "on-suspension",
        """
        (top-level
          (let ((tries 0) (stops 0))
            (guarded outer
              (with-tags
                (par (:tag work
                       (on-suspension (setf stops (+ stops 1))
                         (retry-after-suspension
                           (setf tries (+ tries 1))
                           (guarded-slowly try 0.1 (par (guarded part (sleep 0.5)) (sleep 0.4))))))
                     (guarded pausing
                       (sleep 0.1)
                       (with-task-suspended (work :reason "a break") (sleep 0.3))))))
            (list (>= tries 1) (>= stops 0))))
        """,
        "(T T)",
        evaporated=("(NIL T)",),
    ),
    Plan(
        "without-scheduling",
        """
        (top-level
          (let ((halves 0))
            (guarded outer
              (with-tags
                (pursue (:tag work
                          (guarded-slowly work 0.1
                            (dotimes (n 3)
                              (without-scheduling (setf halves (+ halves 1)) (sleep 0.1) (setf halves (+ halves 1)))
                              (with-scheduling (sleep 0.1)))))
                        (guarded meddling (sleep 0.1) (suspend work :sync nil) (sleep 0.3) (wake-up work) (sleep 9)))))
            (evenp halves)))
        """,
        "T",
    ),
    Plan(
        "callbacks",
        """
        (top-level
          (let ((x (make-fluent :name 'x :value 0)) (seen nil))
            (guarded outer
              (register-update-callback x 'note (lambda (new) (push new seen)))
              (unwind-protect
                (par (guarded one (dotimes (n 3) (sleep 0.1) (setf (value x) (+ 1 n))) :done)
                     (guarded looking (dotimes (n 3) (sleep 0.1) (value x)))
                     (guarded two (wait-for (= x 2) :timeout 1) (setf (value x) 7)))
                (remove-update-callback x 'note)))
            (list (first (last seen)) (value (> x 0)))))
        """,
        "(1 T)",
        evaporated=("(7 T)",),
    ),
    Plan(
        "evaporating-others",
        """
        (top-level
          (guarded outer
            (with-tags
              (par (:tag one (guarded-slowly one 0.2 (sleep 10)))
                   (:tag two (guarded-slowly two 0.1 (par (sleep 10) (guarded deep (sleep 20)))))
                   (guarded ender
                     (sleep 0.1)
                     (evaporate one :reason "enough")
                     (suspend two)
                     (guarded while-suspended (sleep 0.1))
                     (evaporate two :sync nil)
                     (wait-for (task-dead two) :timeout 5)
                     :ended)))
            :all-ended))
        """,
        ":ALL-ENDED",
        evaporated=("Deadlock*",),
    ),
    Plan(
        "process-modules",
        """
        (cpm:def-process-module anomaly-driving (motion)
          (guarded-slowly driving 0.1 (par (sleep 0.2) (guarded wheel (sleep 0.1))) (desig:desig-prop-value motion :goal)))
        (guarded around
          (cpm:with-process-modules-running (anomaly-driving)
            (top-level
              (guarded outer
                (flet ((drive (goal) (cpm:pm-execute 'anomaly-driving (desig:make-designator :motion `((:type :driving) (:goal ,goal))))))
                  (par (guarded first-drive (drive 1))
                       (guarded second-drive (sleep 0.1) (drive 2))
                       (pursue (drive 3) (sleep 0.3))))))))
        """,
        "1",
        evaporated=("UnknownProcessModule*", "ProcessModuleNotRunning*", "SimplePlanFailure: The execution of*", "no values"),
        failed=("SimplePlanFailure: The execution of*",),
    ),
    Plan(
        "perform",
        """
        (cpm:def-process-module anomaly-drawing (motion)
          (guarded drawing (sleep 0.1) (desig:desig-prop-value motion :shape)))
        (prolog:def-fact-group anomaly-matching (cpm:matching-process-module cpm:available-process-module desig:motion-grounding)
          (prolog:<- (cpm:matching-process-module ?d anomaly-drawing) (desig:desig-prop ?d (:type :anomaly-drawing)))
          (prolog:<- (cpm:available-process-module anomaly-drawing))
          (prolog:<- (desig:motion-grounding ?d (draw ?shape))
            (desig:desig-prop ?d (:type :anomaly-drawing)) (desig:desig-prop ?d (:shape ?shape))))
        (cpm:with-process-modules-running (anomaly-drawing)
          (top-level
            (guarded outer
              (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return :failed)))
                (par (exe:perform (desig:a motion (type anomaly-drawing) (shape house)))
                     (guarded beside (sleep 0.1)) (guarded-slowly besides 0.1 (sleep 0.1)))))))
        """,
        ":HOUSE",
        evaporated=(":FAILED", "no values", "ProcessModuleNotRunning*"),
        failed=(":FAILED",),
    ),
    Plan(
        "everything-at-once",
        """
        (def-cram-function anomaly-reach (goal)
          (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return :missed)))
            (guarded-slowly reach 0.1
              (with-policy timeout-policy (5)
                (pursue (progn (wait-for goal :timeout 3) :reached)
                        (guarded watchdog (sleep 4) (fail "too slow")))))))
        (top-level
          (let ((goal (make-fluent :name 'goal :value nil)))
            (guarded outer
              (with-tags
                (par (:tag reach (try-in-order (guarded first-try (sleep 0.1) (fail "slipped")) (anomaly-reach goal)))
                     (:tag signal (guarded signal (sleep 0.5) (setf (value goal) t)))
                     (guarded pauses
                       (sleep 0.2)
                       (with-task-suspended (reach) (par-loop (n '(0.1 0.2)) (guarded pause (sleep n))))))))))
        """,
        ":REACHED",
        evaporated=("no values",),
        failed=(":MISSED",),
    ),
]
