;;;; Results of tests, and how they are shown.

(in-package #:lisp-unit)

(defvar *print-summary* nil "Whether each test's counts are printed when it has run.")
(defvar *print-failures* nil "Whether the failures of each test are printed when it has run.")
(defvar *print-errors* nil "Whether the error that ended a test is printed when it has run.")
(defvar *summarize-results* t "Whether a run ends with a summary.")

(defclass test-result ()
  ((name :initarg :name :reader name)
   (pass :initarg :pass :reader pass)
   (fail :initarg :fail :reader fail)
   (exerr :initarg :exerr :initform nil :reader exerr)
   (place :initarg :place :initform nil :reader place))
  (:documentation "The result of one test: passed assertions, failures in order, and the error that ended it, with its place."))

(defclass test-results-db ()
  ((database :initform (make-hash-table :test #'eq) :reader database)
   (pass :initform 0 :accessor pass)
   (fail :initform 0 :accessor fail)
   (exerr :initform 0 :accessor exerr)
   (failed-tests :initform '() :accessor failed-tests)
   (error-tests :initform '() :accessor error-tests)
   (missing-tests :initform '() :accessor missing-tests))
  (:documentation "The results of a run."))

(defmethod print-object ((object test-results-db) stream)
  (format stream "#<~A Total(~D) Passed(~D) Failed(~D) Errors(~D)>"
          (class-name (class-of object)) (+ (pass object) (fail object)) (pass object) (fail object) (exerr object)))

(defun test-names (results)
  "The names of the tests that ran."
  (loop for name being the hash-keys of (database results) collect name))

(defun record (results result)
  "Add the result of one test, and print what is to be printed of it."
  (let ((name (name result)))
    (setf (gethash name (database results)) result)
    (incf (pass results) (pass result))
    (when (fail result)
      (incf (fail results) (length (fail result)))
      (setf (failed-tests results) (append (failed-tests results) (list name))))
    (when (exerr result)
      (incf (exerr results))
      (setf (error-tests results) (append (error-tests results) (list name)))))
  (when *print-failures* (print-failures result))
  (when *print-errors* (print-errors result))
  (when (or *print-summary* *print-failures* *print-errors*) (print-summary result))
  results)

(defun print-summary (result &optional (stream *standard-output*))
  "The counts of one test."
  (format stream "~&~A: ~D assertions passed, ~D failed~@[, and an execution error~].~2%"
          (name result) (pass result) (length (fail result)) (exerr result)))

(defgeneric print-failures (result &optional stream)
  (:documentation "Print the failed assertions of a result, or of all results of a run."))

(defmethod print-failures ((result failure-result) &optional (stream *standard-output*))
  (format stream "~& | Failed Form: ~S" (form result))
  (destructuring-bind (expects sees)
      (ecase (kind result)
        ((:equal :result) '("Expected " "but saw "))
        (:error '("Should have signalled " "but saw "))
        (:macro '("Should have expanded to " "but saw "))
        (:output '("Should have printed " "but saw ")))
    (format stream "~& | ~A~{~S~^; ~}" expects (expected result))
    ;; what was seen goes to a line of its own when it would not end within 80 columns
    (format stream "~:[ ~;~% | ~]~A~{~S~^; ~}"
            (let ((*print-pretty* nil))
              (> (length (format nil " | ~A~{~S~^; ~} ~A~{~S~^; ~}" expects (expected result) sees (actual result))) 80))
            sees (actual result)))
  (format stream "~{~& | ~S => ~S~}" (extras result))
  (format stream "~& |~%"))

(defmethod print-failures ((result test-result) &optional (stream *standard-output*))
  (dolist (failure (fail result))
    (print-failures failure stream)))

(defmethod print-failures ((results test-results-db) &optional (stream *standard-output*))
  (dolist (name (failed-tests results))
    (print-failures (gethash name (database results)) stream)
    (print-summary (gethash name (database results)) stream)))

(defgeneric print-errors (result &optional stream)
  (:documentation "Print the error that ended a test, or those of all tests of a run."))

(defmethod print-errors ((result test-result) &optional (stream *standard-output*))
  (when (exerr result)
    (let ((*print-escape* nil))
      (format stream "~& | Execution error:~% | ~W~%" (exerr result)))
    (format stream " |~%")))

(defmethod print-errors ((results test-results-db) &optional (stream *standard-output*))
  (dolist (name (error-tests results))
    (print-errors (gethash name (database results)) stream)
    (print-summary (gethash name (database results)) stream)))

(defun summarize-results (results &optional (stream *standard-output*))
  "Print the counts of a run."
  (format stream "~&Unit Test Summary~%")
  (format stream " | ~D assertions total~%" (+ (pass results) (fail results)))
  (format stream " | ~D passed~%" (pass results))
  (format stream " | ~D failed~%" (fail results))
  (format stream " | ~D execution errors~%" (exerr results))
  (format stream " | ~D missing tests~2%" (length (missing-tests results)))
  results)

;;; ------------------------------------------------------------------------------------------------- Test Anything Protocol

(defun write-tap (results &optional (stream *standard-output*))
  "Print the results of a run as TAP 13: one line a test, with its failures in a block below it."
  (format stream "TAP version 13~%1..~D~%" (hash-table-count (database results)))
  (loop for result being the hash-values of (database results)
        for number from 1
        for good = (not (or (fail result) (exerr result)))
        do (format stream "~:[not ok~;ok~] ~D ~A~%" good number (name result))
           (unless good
             (let ((text (with-output-to-string (out)
                           (print-failures result out)
                           (print-errors result out))))
               (format stream "  ---~%")
               (with-input-from-string (in text)
                 (loop for line = (read-line in nil)
                       while line
                       do (format stream "  #~A~%" line)))
               (format stream "  ...~%"))))
  results)

(defun write-tap-to-file (results path)
  "Write the results of a run to the file PATH as TAP 13."
  (with-open-file (stream path :direction :output :if-exists :supersede)
    (write-tap results stream)))
