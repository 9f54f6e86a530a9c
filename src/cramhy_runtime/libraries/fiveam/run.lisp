;;;; Running tests and suites, with what they depend on.

(in-package #:it.bese.fiveam)

(defvar *print-names* t "Whether a run prints the names of tests and suites.")
(defvar *indent* 0 "How deep the suite that runs is.")
(defvar *last-runs* '() "What the last calls of RUN! ran, the last one first.")

(define-condition circular-dependency (error)
  ((test-case :initarg :test-case :reader test-case)
   (ring :initarg :ring :initform '() :reader ring))
  (:report (lambda (condition stream)
             (format stream "A circular dependency was detected in ~S~@[: ~{~S~^ -> ~}~]." (test-case condition) (ring condition)))))

(defvar *ring* '() "The tests whose dependencies are being run, the last one first.")

(defun announce (control name)
  (when *print-names*
    (show "~%~A" (make-string *indent* :initial-element #\Space))
    (show control name)))

(defgeneric run-object (object)
  (:documentation "Run a test or suite that has not run yet; its status: T when all checks passed."))

(defmethod run-object ((suite test-suite))
  (announce "Running test suite ~A" (name suite))
  (let ((*indent* (1+ *indent*)))
    (setf (status suite)
          (let ((good t))
            (dolist (name (tests suite) good)
              (unless (eq (run-object (get-test name)) t) (setf good nil)))))))

(defmethod run-object ((test test-case))
  (case (status test)
    (:unknown
     (setf (status test) :resolving)
     (let ((*ring* (cons (name test) *ring*)))
       (cond ((satisfied-p (depends-on test) test)
              (setf (status test) (run-test test)))
             ((eq (status test) :circular))
             (t (push (make-instance 'test-skipped :test-case test :reason "Dependencies not satisfied") *results*)
                (setf (status test) :depends-not-satisfied)))))
    (:resolving
     (restart-case (error 'circular-dependency :test-case test :ring (reverse (cons (name test) *ring*)))
       (skip ()
         :report (lambda (stream) (format stream "Skip the test ~S and all its dependencies." (name test)))
         (push (make-instance 'test-skipped :test-case test :reason "Circular dependencies") *results*)
         (setf (status test) :circular))))
    (t (status test))))

(defun satisfied-p (dependency test)
  "Whether what TEST depends on is as it should be: a name, or a list with AND, OR, NOT or :BEFORE; what has not run runs first."
  (flet ((status-of (dependency)
           (if (consp dependency) (satisfied-p dependency test) (eq (run-object (needed dependency test)) t))))
    (if (atom dependency)
        (or (null dependency) (status-of dependency))
        (destructuring-bind (operator . dependencies) dependency
          (case operator
            (and (every #'status-of dependencies))
            (or (some #'status-of dependencies))
            (not (notany #'status-of dependencies))
            (:before (dolist (name dependencies t) (run-object (needed name test))))
            (t (error "Test ~S: a dependency is the name of a test or a list with AND, OR, NOT or :BEFORE, not ~S."
                      (name test) dependency)))))))

(defun needed (name test)
  (or (get-test name)
      (error "Test ~S depends on ~S, which is no test." (name test) name)))

(defun run-test (test)
  "Run the function of TEST, whose results are added to *RESULTS*; T unless a check failed."
  (announce "Running test ~A " (name test))
  (let ((results
          (let ((*results* '()) (*current-test* test) (*package* (runtime-package test)))
            (block running
              (handler-bind ((check-failure
                               (lambda (condition)
                                 (declare (ignore condition))
                                 (unless (or (eq *on-failure* :debug) *debug-on-failure*)
                                   (invoke-restart 'ignore-failure))))
                             (serious-condition
                               (lambda (condition)
                                 (unless (or (eq *on-error* :debug) *debug-on-error* (typep condition 'check-failure))
                                   (add-result 'unexpected-test-failure
                                               :condition condition :place (cramhy::source-position)
                                               :reason (format nil "Unexpected Error: ~S~%~A." condition condition))
                                   (return-from running *results*)))))
                (cramhy::within-limit (test-function test)))
              *results*))))
    (setf *results* (append *results* results))
    (notany (lambda (result) (typep result 'test-failure)) results)))

(defgeneric run-spec (spec)
  (:documentation "Run what a test, suite, name or list of them means."))

(defmethod run-spec ((spec testable-object)) (run-object spec))
(defmethod run-spec ((spec list))
  (if (null spec) (run-spec (get-test nil)) (mapc #'run-spec spec)))
(defmethod run-spec ((spec symbol))
  (run-spec (or (get-test spec) (error "Unknown test or suite ~S." spec))))

(defun run (test-spec &key ((:print-names *print-names*) *print-names*))
  "Run a test, a suite or a list of them; the list of results."
  (loop for test being the hash-values of *tests* do (setf (status test) :unknown))
  (let ((*results* '()) (*indent* 0) (*ring* '()))
    (run-spec test-spec)
    *results*))

(defun run! (&optional (test-spec *suite*) &key ((:print-names *print-names*) *print-names*))
  "Run and explain; whether nothing failed."
  (setf *last-runs* (cons test-spec (subseq *last-runs* 0 (min 2 (length *last-runs*)))))
  (explain! (run test-spec)))

(defun run-again (number)
  (if (< number (length *last-runs*))
      (explain! (run (nth number *last-runs*)))
      (format t "~&No tests have been run yet.~%")))

(defun ! () "Run again what was run last." (run-again 0))
(defun !! () "Run again what was run before the last run." (run-again 1))
(defun !!! () "Run again what was run two runs before the last." (run-again 2))

(defun debug! (&optional (test-spec *suite*))
  "RUN! with a debugger for errors and failures."
  (let ((*on-error* :debug) (*on-failure* :debug))
    (run! test-spec)))

(defun run-all-tests (&key (summary :end))
  "Run all suites, and explain at the END, after each SUITE, or not at all (NIL). Whether nothing failed."
  (check-type summary (member nil :suite :end))
  (let ((all '()))
    (loop for suite being the hash-values of *tests*
          when (and (typep suite 'test-suite) (null (test-suite suite)) (or (name suite) (tests suite)))
            do (let ((results (run suite)))
                 (when (eq summary :suite) (explain! results))
                 (setf all (append results all))))
    (when (eq summary :end) (explain! all))
    (values (results-status all))))

(defun results-status (result-list)
  "Whether nothing failed; the failures; the skipped tests."
  (flet ((those (class) (remove-if-not (lambda (result) (typep result class)) result-list)))
    (values (null (those 'test-failure)) (those 'test-failure) (those 'test-skipped))))
