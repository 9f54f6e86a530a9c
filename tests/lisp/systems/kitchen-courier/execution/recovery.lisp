;;;; Recovering from failures: retries, restarts, and a macro that offers them.

(in-package #:courier-plans)

(defun invoke-if-there (name &rest arguments)
  (lambda (condition)
    (when-let (restart (find-restart name condition))
      (apply #'invoke-restart restart arguments))))

(defun skip-task (&optional condition) (when-let (restart (find-restart 'skip-task condition)) (invoke-restart restart)))
(defun give-up (&optional value) (invoke-restart 'give-up value))
(defun use-other-arm (&optional condition) (funcall (invoke-if-there 'use-other-arm) condition))

(defmacro with-recovery ((&rest clauses) &body body)
  "Run BODY; a CLAUSE (failure (variable &key retries) form...) handles a failure in BODY, before it unwinds.
In a clause (RETRY) runs BODY again, at most RETRIES times, and (GIVE-UP value) leaves."
  (with-gensyms (again block)
    (let ((counters (loop for nil in clauses collect (gensym "RETRIES"))))
      `(let ,(loop for (nil (nil . options)) in clauses
                   for counter in counters
                   collect `(,counter ,(getf options :retries 3)))
         (block ,block
           (tagbody
              ,again
              (restart-case
                  (return-from ,block
                    (handler-bind
                        ,(loop for (failure (variable . nil) . forms) in clauses
                               for counter in counters
                               collect `(,failure (lambda (,variable)
                                                    (declare (ignorable ,variable))
                                                    (flet ((retry ()
                                                             (when (plusp ,counter)
                                                               (decf ,counter)
                                                               (log-event :retry ',failure ,counter)
                                                               (invoke-restart 'retry-with))))
                                                      (declare (ignorable #'retry))
                                                      ,@forms))))
                      ,@body))
                (retry-with () :report "Try again." (go ,again))
                (give-up (value) :report "Give up." (return-from ,block value)))))))))

(defun call-with-energy (function)
  "Call FUNCTION; count the warnings about the battery, and go on."
  (let ((warnings 0))
    (handler-bind ((low-battery (lambda (warning) (incf warnings) (muffle-warning warning))))
      (multiple-value-call #'values (funcall function) warnings))))

(defun restart-names (condition)
  (loop for restart in (compute-restarts condition)
        for name = (restart-name restart)
        when (member name '(retry-with give-up skip-task use-other-arm use-value))
          collect name))
