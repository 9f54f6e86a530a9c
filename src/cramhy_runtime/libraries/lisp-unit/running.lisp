;;;; Running tests.

(in-package #:lisp-unit)

(defvar *use-debugger* nil "Whether an error in a test enters the debugger: NIL, T or :ASK.")
(defvar *signal-results* nil "Whether a run ends with the condition TEST-RUN-COMPLETE.")

(define-condition test-run-complete ()
  ((results :initarg :results :reader results))
  (:documentation "Signalled after a run when SIGNAL-RESULTS asked for it."))

(defun use-debugger (&optional (flag t))
  "Let errors in tests enter the debugger: T always, :ASK after a question, NIL never."
  (setf *use-debugger* flag))

(defun signal-results (&optional (flag t))
  "Let a run signal TEST-RUN-COMPLETE with its results."
  (setf *signal-results* flag))

(defun debug-p (condition)
  "Whether CONDITION is to enter the debugger."
  (if (eq *use-debugger* :ask)
      (y-or-n-p "~A -- debug?" condition)
      *use-debugger*))

(defun run-test (test)
  "Run a test; its result. An error ends the test, not the run."
  (let ((*pass* 0) (*fail* '()))
    (flet ((result (&optional error place)
             (make-instance 'test-result :name (name test) :pass *pass* :fail (reverse *fail*) :exerr error
                                         :place (or place (place test)))))
      (block running
        (handler-bind ((serious-condition
                         (lambda (condition)
                           (unless (debug-p condition)
                             (return-from running (result condition (cramhy::source-position)))))))
          (cramhy::within-limit (thunk test)))
        (result)))))

(defun run-tests (&optional (test-names :all) (package *package*))
  "Run the tests of PACKAGE called TEST-NAMES, a list or :ALL, and print a summary. Returns the results."
  (let ((table (test-table package)))
    (when table
      (let ((results (make-instance 'test-results-db)))
        (dolist (name (if (eq test-names :all) (list-tests package) (if (listp test-names) test-names (list test-names))))
          (let ((test (gethash name table)))
            (if test
                (record results (run-test test))
                (setf (missing-tests results) (append (missing-tests results) (list name))))))
        (finish results)))))

(defun finish (results)
  "Show and signal RESULTS as the user asked for it."
  (when *summarize-results* (summarize-results results))
  (when *signal-results* (signal 'test-run-complete :results results))
  results)

(defun run-all-tests (&optional (package *package*))
  "Run all tests of PACKAGE."
  (run-tests :all package))

(defun run-tags (&optional (tags :all) (package *package*))
  "Run the tests of PACKAGE that have one of TAGS, a list or :ALL."
  (run-tests (tagged-tests (if (listp tags) tags (if (eq tags :all) :all (list tags))) package) package))
