;;;; Assertions: each compares the values of a form with what is expected of it, and counts.

(in-package #:lisp-unit)

(defvar *pass* nil "The number of assertions that passed in the test that runs.")
(defvar *fail* nil "The failures of the test that runs, the last one first.")

(defclass failure-result ()
  ((kind :initarg :kind :reader kind)
   (form :initarg :form :reader form)
   (actual :initarg :actual :reader actual)
   (expected :initarg :expected :reader expected)
   (extras :initarg :extras :reader extras)
   (place :initarg :place :reader place))
  (:documentation "An assertion that failed: its form, lists of values, the extra forms with their values, and the place."))

(defun check (kind form actual expected extras test)
  "Evaluate an assertion. ACTUAL, EXPECTED and EXTRAS are functions that compute them. Returns whether it passed."
  (let* ((saw (multiple-value-list (funcall actual)))
         (wanted (multiple-value-list (funcall expected)))
         (passed (passed-p kind wanted saw test)))
    (if passed
        (when *pass* (incf *pass*))
        (push (make-instance 'failure-result :kind kind :form form :actual saw :expected wanted
                                             :extras (when extras (funcall extras)) :place (cramhy::source-position))
              *fail*))
    (if passed t nil)))

(defun passed-p (kind expected actual test)
  "Whether the values ACTUAL are what an assertion of the KIND expects."
  (ecase kind
    (:equal (and (<= (length expected) (length actual))
                 (every test expected actual)))
    (:error (or (eq (first actual) (first expected))
                (typep (first actual) (first expected))))
    (:macro (same-but-for-fresh-symbols (first expected) (first actual)))
    (:output (string= (trimmed (first expected)) (trimmed (first actual))))
    (:result (logically-equal (first actual) (first expected)))))

(defun trimmed (text)
  (string-trim '(#\Newline #\Return #\Space) text))

(defun same-but-for-fresh-symbols (expected actual)
  "Whether the forms are equal when each uninterned symbol of ACTUAL stands for those of one name in EXPECTED, where each is read anew."
  (let ((pairs '()))
    (labels ((fresh-p (thing) (and thing (symbolp thing) (null (symbol-package thing))))
             (same (a b)
               (cond ((and (fresh-p a) (fresh-p b))
                      (let ((pair (or (assoc a pairs :test #'string=) (rassoc b pairs))))
                        (if pair
                            (and (string= (car pair) a) (eq (cdr pair) b))
                            (push (cons a b) pairs))))
                     ((and (consp a) (consp b)) (and (same (car a) (car b)) (same (cdr a) (cdr b))))
                     (t (equal a b)))))
      (and (same expected actual) t))))

(defmacro expand-assert (kind form actual expected extras &key (test '#'eql))
  "A call of CHECK; EXTRAS are shown with their values on failure."
  `(check ,kind ',form (lambda () ,actual) (lambda () ,expected)
          ,(when extras
             `(lambda () (list ,@(loop for extra in extras collect `',extra collect extra))))
          ,test))

(defmacro assert-eq (expected form &rest extras)
  "FORM's values are EQ to those of EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'eq))

(defmacro assert-eql (expected form &rest extras)
  "FORM's values are EQL to those of EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'eql))

(defmacro assert-equal (expected form &rest extras)
  "FORM's values are EQUAL to those of EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'equal))

(defmacro assert-equalp (expected form &rest extras)
  "FORM's values are EQUALP to those of EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'equalp))

(defmacro assert-equality (test expected form &rest extras)
  "FORM's values are equal under TEST to those of EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test ,test))

(defmacro assert-nil (form &rest extras)
  "FORM's value is NIL."
  `(expand-assert :equal ,form ,form nil ,extras))

(defmacro assert-true (form &rest extras)
  "FORM's value is true."
  `(expand-assert :result ,form ,form t ,extras))

(defmacro assert-false (form &rest extras)
  "FORM's value is false."
  `(expand-assert :result ,form ,form nil ,extras))

(defmacro assert-error (condition form &rest extras)
  "FORM signals CONDITION, which is evaluated: a type or an object."
  `(expand-assert :error ,form (handler-case ,form (condition (condition) condition)) ,condition ,extras))

(defmacro assert-expands (expansion form &rest extras)
  "The macro call FORM expands to EXPANSION; fresh symbols may stand for fresh symbols."
  `(expand-assert :macro ,form (values (macroexpand-1 ',form)) ',expansion ,extras))

(defmacro assert-prints (output form &rest extras)
  "FORM prints OUTPUT; white space around it does not count."
  `(expand-assert :output ,form (with-output-to-string (*standard-output*) ,form) ,output ,extras))

(defun logically-equal (x y)
  "Whether both are true, or both false."
  (eq (not x) (not y)))

(defun set-equal (list1 list2 &rest initargs &key key (test #'equal))
  "Whether the lists have the same elements."
  (declare (ignore key test))
  (and (listp list1) (listp list2)
       (let ((initargs (if (member :test initargs) initargs (list* :test #'equal initargs))))
         (and (apply #'subsetp list1 list2 initargs)
              (apply #'subsetp list2 list1 initargs)))))
