;;;; As much of lisp-unit as the systems beside it use, for SBCL: DEFINE-TEST, assertions, RUN-TESTS and its summary.

(defpackage #:lisp-unit
  (:use #:common-lisp)
  (:export #:define-test #:run-tests #:assert-true #:assert-false #:assert-eq #:assert-eql #:assert-equal #:assert-equalp
           #:assert-equality #:assert-error #:assert-expands #:assert-prints #:assert-number-equal))

(in-package #:lisp-unit)

(defvar *tests* (make-hash-table :test #'eq) "From a package to a list of (name . function), the newest first.")
(defvar *passed*)
(defvar *failed*)

(defun note-result (passed form expected actual)
  (cond (passed (incf *passed*))
        (t (incf *failed*)
           (format t " | Failed Form: ~S~% | Expected ~{~S~^; ~} but saw ~{~S~^; ~}~%" form expected actual)))
  passed)

(defmacro define-test (name &body body)
  (when (stringp (first body)) (pop body))
  `(progn
     (setf (gethash *package* *tests*)
           (acons ',name (lambda () ,@body) (remove ',name (gethash *package* *tests*) :key #'car)))
     ',name))

(defmacro assert-equality (test expected form)
  `(let ((expected (multiple-value-list ,expected)) (actual (multiple-value-list ,form)))
     (note-result (and (<= (length expected) (length actual)) (every ,test expected actual)) ',form expected actual)))

(macrolet ((define (&rest pairs)
             `(progn ,@(loop for (name test) in pairs
                             collect `(defmacro ,name (expected form) (list 'assert-equality ',test expected form))))))
  (define (assert-eq #'eq) (assert-eql #'eql) (assert-equal #'equal) (assert-equalp #'equalp) (assert-number-equal #'=)))

(defmacro assert-true (form) `(let ((value ,form)) (note-result value ',form '(t) (list value))))
(defmacro assert-false (form) `(let ((value ,form)) (note-result (not value) ',form '(nil) (list value))))

(defmacro assert-error (condition form)
  `(let ((value (handler-case (progn ,form nil) (condition (condition) condition))))
     (note-result (typep value ,condition) ',form (list ,condition) (list value))))

(defmacro assert-expands (expansion form)
  `(let ((actual (macroexpand-1 ',form)))
     (note-result (equal ',expansion actual) ',form (list ',expansion) (list actual))))

(defmacro assert-prints (text form)
  `(let ((actual (with-output-to-string (*standard-output*) ,form)))
     (flet ((clean (string) (string-trim '(#\Space #\Newline) string)))
       (note-result (string= (clean ,text) (clean actual)) ',form (list ,text) (list actual)))))

(defun run-tests (&optional (names :all) (package *package*))
  (let* ((*package* (find-package package)) (tests (reverse (gethash *package* *tests*)))
         (names (if (eq names :all) (mapcar #'car tests) names))
         (*passed* 0) (*failed* 0) (errors 0) (missing 0))
    (dolist (name names)
      (let ((function (cdr (assoc name tests))))
        (if (null function)
            (incf missing)
            (handler-case (funcall function)
              (error (condition) (incf errors) (format t " | Execution error in ~S: ~A~%" name condition))))))
    (format t "~&Unit Test Summary~% | ~D assertions total~% | ~D passed~% | ~D failed~% | ~D execution errors~% | ~D missing tests~2%"
            (+ *passed* *failed*) *passed* *failed* errors missing)
    (values)))
