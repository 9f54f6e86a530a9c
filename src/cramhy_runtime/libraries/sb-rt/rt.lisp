;;;; SB-RT: the regression tester RT. A test is a form and the values that it must have. Source: R. Waters, Some Useful Lisp Algorithms, 1991.

(defpackage #:sb-rt
  (:use #:common-lisp)
  (:export #:*do-tests-when-defined* #:*test* #:continue-testing #:deftest #:do-test #:do-tests #:get-test #:pending-tests
           #:rem-all-tests #:rem-test))
(in-package #:sb-rt)

(defvar *test* nil "The name of the current test.")
(defvar *do-tests-when-defined* nil)
(defvar *compile-tests* nil "Whether a test is compiled before it is run.")
(defvar *catch-errors* t "Whether an error in a test is a failure, and not an error of DO-TEST.")
(defvar *expected-failures* '() "The names of tests that may fail.")
(defvar *tests* (make-array 0 :adjustable t :fill-pointer t) "All tests, in the order of their definition.")
(defvar *in-test* nil)

(defstruct test pending name form values)

(defmacro deftest (name form &rest values)
  `(add-test ',name ',form ',values))

(defun find-test (name) (find name *tests* :key #'test-name :test #'equal))

(defun add-test (name form values)
  (let ((new (make-test :pending t :name name :form form :values values)) (old (position name *tests* :key #'test-name :test #'equal)))
    (cond (old (setf (aref *tests* old) new) (warn "Redefining test ~S" name))
          (t (vector-push-extend new *tests*))))
  (setf *test* name)
  (if *do-tests-when-defined* (do-test name) name))

(defun known-test (name)
  (or (find-test name) (error "~@<No test with name ~:@(~S~).~:@>" name)))

(defun get-test (&optional (name *test*))
  (let ((test (known-test name))) (list* (test-name test) (test-form test) (test-values test))))

(defun rem-test (&optional (name *test*))
  (when (find-test name)
    (setf *tests* (delete name *tests* :key #'test-name :test #'equal))
    name))

(defun rem-all-tests () (setf (fill-pointer *tests*) 0) nil)

(defun pending-tests () (loop for test across *tests* when (test-pending test) collect (test-name test)))

(defun same-values-p (x y)
  "Whether two values are EQUAL, or arrays and numbers of which that holds in each part."
  (cond ((consp x) (and (consp y) (same-values-p (car x) (car y)) (same-values-p (cdr x) (cdr y))))
        ((and (typep x '(and array (not string))) (typep y 'array))
         (and (equal (array-dimensions x) (array-dimensions y))
              (loop for i below (array-total-size x) always (same-values-p (row-major-aref x i) (row-major-aref y i)))))
        (t (eql-or-equal x y))))

(defun eql-or-equal (x y) (or (eql x y) (equal x y)))

(defun value-of (test)
  (flet ((evaluate ()
           (multiple-value-list (if *compile-tests* (funcall (compile nil `(lambda () ,(test-form test)))) (eval (test-form test))))))
    (if *catch-errors*
        (handler-case (evaluate) (error (condition) (list condition)))
        (evaluate))))

(defun run-test (test &optional (stream *standard-output*))
  "The name of TEST if it succeeds; else nil, and STREAM gets what came."
  (let* ((*in-test* t) (found (value-of test)))
    (setf (test-pending test) (not (same-values-p found (test-values test))))
    (cond ((not (test-pending test)) (test-name test))
          (t (format stream "~&Test ~:@(~S~) failed~%Form: ~S~%Expected value~P: ~{~S~^~%~17T~}~%Actual value~P: ~{~S~^~%~15T~}.~%"
                     (test-name test) (test-form test) (length (test-values test)) (test-values test) (length found) found)
             nil))))

(defun do-test (&optional (name *test*))
  (run-test (known-test name)))

(defun do-tests (&optional (out *standard-output*))
  (loop for test across *tests* do (setf (test-pending test) t))
  (if (streamp out)
      (run-pending out)
      (with-open-file (stream out :direction :output) (run-pending stream))))

(defun continue-testing () (run-pending *standard-output*))

(defun run-pending (stream)
  "Run the tests that are pending. Whether only those failed that were expected to, the others that failed, and all that failed."
  (let ((all (length *tests*)))
    (format stream "~&Doing ~A pending test~:P of ~A tests total.~%" (count-if #'test-pending *tests*) all)
    (loop for test across *tests*
          when (and (test-pending test) (run-test test stream))
            do (format stream "~@[~<~%~:; ~:@(~S~)~>~]" (test-name test)))
    (let* ((failed (pending-tests)) (new (set-difference failed *expected-failures* :test #'equal)))
      (if (null failed)
          (format stream "~&No tests failed.")
          (format stream "~&~A out of ~A total tests failed: ~:@(~{~<~%   ~1:;~S~>~^, ~}~).~@[~%~A unexpected failures: ~:@(~{~S~^, ~}~).~]"
                  (length failed) all failed (and new *expected-failures* (length new)) new))
      (finish-output stream)
      (values (null new) new failed))))

(provide "SB-RT")
