;;;; Tests, suites and fixtures, and where they are kept.

(in-package #:it.bese.fiveam)

(defvar *tests* (make-hash-table :test #'eq) "Tests and suites by name.")
(defvar *fixtures* (make-hash-table :test #'eq) "Fixtures by name: (lambda-list . body).")
(defvar *suite* nil "The suite that new tests go to: the one of the last IN-SUITE.")
(defvar *run-test-when-defined* nil "Whether a test is run as soon as it is defined.")
(defvar *default-test-compilation-time* :definition-time)

(defclass testable-object ()
  ((name :initarg :name :reader name)
   (description :initarg :description :initform "" :accessor description)
   (depends-on :initarg :depends-on :initform nil :reader depends-on)
   (status :initform :unknown :accessor status)
   (suite :initarg :suite :initform nil :accessor test-suite)))

(defclass test-case (testable-object)
  ((function :initarg :function :reader test-function)
   (package :initarg :package :reader runtime-package)
   (place :initarg :place :reader place)))

(defclass test-suite (testable-object)
  ((tests :initform '() :accessor tests))
  (:documentation "TESTS are names, in the order of definition."))

(defmethod print-object ((object testable-object) stream)
  (print-unreadable-object (object stream :type t :identity t)
    (format stream "~S" (name object))))

(defun get-test (key &optional default)
  "The test or suite called KEY."
  (gethash key *tests* default))

(defun test-names ()
  "The names of all tests and suites, the last one first."
  (reverse (loop for name being the hash-keys of *tests* collect name)))

(defun rem-test (key)
  "Forget the test or suite KEY; whether there was one."
  (let ((test (get-test key)))
    (when (and test (test-suite test))
      (setf (tests (test-suite test)) (remove key (tests (test-suite test)))))
    (remhash key *tests*)))

(defun enter-test (test)
  "Keep TEST, in place of one of its name."
  (let ((old (get-test (name test))) (suite (test-suite test)))
    (when (and old (test-suite old) (not (eq (test-suite old) suite)))
      (setf (tests (test-suite old)) (remove (name test) (tests (test-suite old)))))
    (when (and suite (not (member (name test) (tests suite))))
      (setf (tests suite) (append (tests suite) (list (name test)))))
    (setf (gethash (name test) *tests*) test)))

;;; ---------------------------------------------------------------------------------------------------------------- suites

(defun find-suite (designator)
  "The suite that a suite or its name means; an unknown one is an error."
  (let ((suite (if (typep designator 'test-suite) designator (get-test designator))))
    (if (typep suite 'test-suite)
        suite
        (error "Unknown suite ~A." designator))))

(defun make-suite (name &key description ((:in parent-suite)))
  "Make the suite NAME, below PARENT-SUITE if it is given; the tests of one of that name stay."
  (let* ((parent (and parent-suite (find-suite parent-suite)))
         (old (get-test name))
         (suite (make-instance 'test-suite :name name :suite parent)))
    (when (typep old 'test-suite)
      (setf (tests suite) (tests old))
      (dolist (test (tests suite))
        (setf (test-suite (get-test test)) suite)))
    (when description (setf (description suite) description))
    (enter-test suite)
    suite))

(make-suite nil :description "Global Suite")
(setf *suite* (get-test nil))

(defmacro def-suite (name &key description in)
  "Define the suite NAME, in the suite IN."
  `(progn (make-suite ',name ,@(when description `(:description ,description)) ,@(when in `(:in ',in)))
          ',name))

(defmacro in-suite (suite-name)
  "Let the tests that follow belong to the suite."
  `(progn (setf *suite* (find-suite ',suite-name))
          ',suite-name))

(defmacro def-suite* (name &rest def-suite-args)
  "Define the suite NAME and let the tests that follow belong to it."
  `(progn (def-suite ,name ,@def-suite-args)
          (in-suite ,name)))

(defmacro in-suite* (suite-name &key in)
  "Let the tests that follow belong to the suite, which is defined if need be."
  `(def-suite* ,suite-name ,@(when in `(:in ,in))))

;;; --------------------------------------------------------------------------------------------------------------- fixtures

(defun get-fixture (key &optional default)
  (gethash key *fixtures* default))

(defun rem-fixture (key)
  (remhash key *fixtures*))

(defmacro def-fixture (name (&rest args) &body body)
  "Define a fixture: BODY around a test, which stands where (&BODY) is."
  `(eval-when (:compile-toplevel :load-toplevel :execute)
     (setf (gethash ',name *fixtures*) '(,args ,@body))
     ',name))

(defmacro with-fixture (fixture-name (&rest args) &body body)
  "BODY inside the fixture, with ARGS for its parameters."
  (let ((fixture (or (get-fixture fixture-name)
                     (error "Unknown fixture ~S." fixture-name))))
    `(funcall (lambda ,(first fixture)
                ,@(subst `(progn ,@body) '(&body) (rest fixture) :test #'equal))
              ,@args)))

;;; ------------------------------------------------------------------------------------------------------------------ tests

(defmacro test (name &body body)
  "Define a test; NAME may be a list with options as for DEF-TEST."
  (destructuring-bind (name &rest options) (if (listp name) name (list name))
    `(def-test ,name ,options ,@body)))

(defmacro def-test (name (&key depends-on (suite '*suite* suite-p) fixture (compile-at *default-test-compilation-time*) profile)
                    &body body)
  "Define a test that runs BODY after the tests that it depends on, inside the fixture if one is given."
  (declare (ignore profile))
  (unless (and name (symbolp name))
    (error "The name of a test is a symbol, not ~S." name))
  (let* ((description (if (stringp (first body)) (pop body) ""))
         (fixture-list (if (listp fixture) fixture (list fixture)))
         (body (if fixture `((with-fixture ,(first fixture-list) ,(rest fixture-list) ,@body)) body)))
    ;; not PROGN, whose parts are top-level forms without the place of the call
    `(prog1 ',name
       (define-test ',name ,description ',depends-on ,(if suite-p `',suite '*suite*)
         (lambda () ,@(if (eq compile-at :run-time) `((eval '(progn ,@body))) body))
         (cramhy::source-position))
       (when *run-test-when-defined* (run! ',name)))))

(defun define-test (name description depends-on suite function place)
  (enter-test (make-instance 'test-case :name name :description description :depends-on depends-on :suite (find-suite suite)
                                        :function function :package *package* :place place)))
