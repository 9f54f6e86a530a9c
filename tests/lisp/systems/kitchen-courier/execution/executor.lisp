;;;; The executive: makes a plan, performs it, plans again after failures.

(in-package #:courier-plans)

(defun perform-step (step)
  (with-recovery ((object-slipped (failure :retries 1)
                    (log-event :failure (princ-to-string failure))
                    (incf (attempts failure))
                    (retry))
                  (grasp-failed (failure)
                    (log-event :failure (princ-to-string failure))
                    (use-other-arm failure))
                  (navigation-failed (failure :retries 2)
                    (log-event :failure (princ-to-string failure))
                    (advance-clock 5)
                    (retry)))
    (apply #'perform step)))

(defun execute-plan (steps)
  "Perform STEPS in order; the number of steps done and the steps that were skipped."
  (let ((skipped '()))
    (values (loop for step in steps
                  count (restart-case (progn (perform-step step) t)
                          (skip-task ()
                            :report (lambda (stream) (format stream "Skip ~(~A~)." step))
                            (push step skipped)
                            nil)))
            (nreverse skipped))))

(defun execute (tasks &key (attempts 3))
  "Do TASKS: plan, perform, and plan again if a plan fails; the tasks done, and why if not all."
  (loop named executive with last-failure = nil
        for attempt from 1 to attempts
        do (handler-case
               (multiple-value-bind (plan cost) (plan-for tasks (facts *world* (robot-place *robot*)))
                 (log-event :note 'plan (length plan) cost)
                 (multiple-value-bind (done skipped) (execute-plan plan)
                   (return-from executive (values :succeeded done skipped attempt))))
             (courier-failure (failure)
               (setf last-failure failure)
               (dolist (arm (arms *robot*))
                 (when-let (load (shiftf (arm-load arm) nil))
                   (put-into load 'table)))
               (log-event :failure (type-of failure) attempt)))
        finally (return-from executive (values :failed 0 (princ-to-string last-failure) attempts))))

(defun tidying-tasks (&optional (*world* *world*))
  "What there is to tidy: dirty things to the dishwasher, food that spoils to the fridge."
  (let ((tasks (collecting (task)
                 (do-objects (thing crockery)
                   (unless (or (clean-p thing) (eq (location-of (name thing)) 'dishwasher))
                     (task `(bring ,(name thing) dishwasher))))
                 (do-objects (thing perishable)
                   (unless (eq (location-of (name thing)) 'fridge)
                     (task `(bring ,(name thing) fridge)))))))
    (append tasks '((all-closed)))))
