(in-package :cram-tray-delivery-tests)
(in-suite time-suite)

(test a-plan-that-waits-for-ever-meets-its-deadline
  (let ((never (make-fluent :name :never :value nil)))
    (signals sb-sys:deadline-timeout
      (sb-sys:with-deadline (:seconds 2)
        (top-level (wait-for never))))
    (signals sb-ext:timeout
      (sb-sys:with-deadline (:seconds 2)
        (sb-thread:join-thread (in-thread "forever" (lambda () (sleep 1000))))))))

(test a-timeout-ends-all-branches
  (let ((put-down '()))
    (signals sb-ext:timeout
      (sb-ext:with-timeout 3
        (top-level
          (par (unwind-protect (carry :a 100) (push :a put-down))
               (unwind-protect (carry :b 200) (push :b put-down))))))
    (is (= 2 (length put-down)))))

(test what-is-quick-enough-is-left-alone
  (is (eq :wood (sb-ext:with-timeout 5 (top-level (carry :wood 1)))))
  (is (eq :wood (sb-sys:with-deadline (:seconds 5) (top-level (carry :wood 1)))))
  (finishes (sb-ext:with-timeout 1 (+ 1 1))))

(test a-deadline-may-be-deferred
  (is (eq :wood
          (let ((deferred nil))
            (handler-bind ((sb-sys:deadline-timeout
                             (lambda (condition)
                               (unless deferred
                                 (setf deferred t)
                                 (sb-sys:defer-deadline 10 condition)))))
              (sb-sys:with-deadline (:seconds 1)
                (carry :wood 5)))))))

(test a-timer-rings
  (let* ((rings 0)
         (timer (sb-ext:make-timer (lambda () (incf rings)) :name "bell")))
    (sb-ext:schedule-timer timer 1 :repeat-interval 1)
    (sleep 3.5)
    (sb-ext:unschedule-timer timer)
    (sleep 3)
    (is (= 3 rings))
    (is-false (sb-ext:timer-scheduled-p timer))))
