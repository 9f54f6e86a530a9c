;;;; Checks: what is tested in a test, and the results that they leave.

(in-package #:it.bese.fiveam)

(defvar *test-dribble* t "Where a run prints; NIL for nowhere.")
(defvar *results* '() "The results of the test that runs, the last one first.")
(defvar *current-test* nil "The test that runs.")
(defvar *on-error* nil "What an error in a test does: NIL, :DEBUG or :BACKTRACE.")
(defvar *on-failure* nil "What a failed check does: NIL, :DEBUG or :BACKTRACE.")
(defvar *debug-on-error* nil "Older name for *ON-ERROR* being :DEBUG.")
(defvar *debug-on-failure* nil "Older name for *ON-FAILURE* being :DEBUG.")

(defclass test-result ()
  ((reason :initarg :reason :initform "no reason given" :reader reason)
   (test-case :initarg :test-case :initform *current-test* :reader test-case)
   (test-expr :initarg :test-expr :initform nil :reader test-expr)
   (place :initarg :place :initform nil :reader place)))

(defclass test-passed (test-result) ())
(defclass test-failure (test-result)
  ((values-text :initarg :values-text :initform nil :reader values-text)))
(defclass unexpected-test-failure (test-failure)
  ((condition :initarg :condition :reader actual-condition)))
(defclass test-skipped (test-result) ())
(defclass for-all-test-failed (test-failure)
  ((result-list :initarg :result-list :reader result-list)))

(define-condition check-failure (error)
  ((reason :initarg :reason :reader reason)
   (test-case :initarg :test-case :reader test-case)
   (test-expr :initarg :test-expr :reader test-expr))
  (:report (lambda (condition stream)
             (format stream "The following check failed: ~S~%~A." (test-expr condition) (reason condition)))))

(defun show (control &rest arguments)
  (apply #'format *test-dribble* control arguments))

(defun add-result (class &rest arguments)
  "Note a result of the running test and print its letter."
  (let ((result (apply #'make-instance class arguments)))
    (show (etypecase result
               (test-passed ".")
               (unexpected-test-failure "X")
               (test-failure "f")
               (test-skipped "s")))
    (push result *results*)
    nil))

(defun process-pass (expression)
  (add-result 'test-passed :test-expr expression)
  t)

(defun process-failure (expression reason &optional values-text)
  "Note a failed check, unless somebody who handles CHECK-FAILURE does something else. VALUES-TEXT: what REASON does not tell of the values."
  (let ((place (cramhy::source-position)))
    (with-simple-restart (ignore-failure "Continue the test run.")
      (error 'check-failure :test-expr expression :reason reason :test-case *current-test*))
    (add-result 'test-failure :test-expr expression :reason reason :values-text values-text :place place)))

(defun reason-form (arguments default)
  "The form of a reason: the user's FORMAT arguments, or DEFAULT."
  (if arguments `(format nil ,@arguments) default))

(defun reason-forms (arguments default)
  "The forms of a reason and, if that is the user's, of what it does not tell."
  (if arguments (list (reason-form arguments default) default) (list default)))

(defun call-p (form)
  "Whether FORM is a call of a function."
  (and (consp form) (symbolp (first form)) (first form)
       (not (macro-function (first form))) (not (special-operator-p (first form)))))

(defmacro is (test &rest reason-args)
  "Check that TEST is true. (PREDICATE EXPECTED ACTUAL), (PREDICATE ACTUAL) and their NOT explain themselves on failure."
  (unless (listp test)
    (error "Argument to IS must be a list, not ~S" test))
  (let* ((negated (and (eq (first test) 'not) (= (length test) 2) (call-p (second test)) (<= 2 (length (second test)) 3)))
         (call (if negated (second test) test)))
    (if (and (call-p call) (not (eq (first call) 'quote)) (<= 2 (length call) 3))
        (destructuring-bind (predicate first &optional (second nil second-p)) call
          (let ((expected (gensym "E")) (actual (gensym "A")))
            `(let (,@(when second-p `((,expected ,first)))
                   (,actual ,(if second-p second first)))
               (if ,(let ((form `(,predicate ,@(when second-p (list expected)) ,actual)))
                      (if negated `(not ,form) form))
                   (process-pass ',test)
                   (process-failure
                    ',test
                    ,@(reason-forms
                      reason-args
                      `(format nil
                               ,(cond ((and negated second-p)
                                       "~2&~S~2% evaluated to ~2%~S~2% which is ~2%~S~2%to ~2%~S~2% (it should not be)")
                                      (negated "~2&~S~2% evaluated to ~2%~S~2% which satisfies ~2%~S~2% (it should not)")
                                      (second-p "~2&~S~2% evaluated to ~2%~S~2% which is not ~2%~S~2% to ~2%~S~2%")
                                      (t "~2&~S~2% evaluated to ~2%~S~2% which does not satisfy ~2%~S~2%"))
                               ',(if second-p second first) ,actual ',predicate ,@(when second-p (list expected)))))))))
        `(if ,test
             (process-pass ',test)
             (process-failure ',test ,@(reason-forms reason-args `(format nil "~2&~S~2% was NIL." ',test)))))))

(defmacro is-true (condition &rest reason-args)
  "Check that the value of CONDITION is true."
  `(if ,condition
       (process-pass ',condition)
       (process-failure ',condition ,@(reason-forms reason-args `(format nil "~S did not return a true value" ',condition)))))

(defmacro is-false (condition &rest reason-args)
  "Check that the value of CONDITION is NIL."
  (let ((value (gensym "VALUE")))
    `(let ((,value ,condition))
       (if ,value
           (process-failure ',condition
                            ,@(reason-forms reason-args
                                          `(format nil "~S returned the value ~S, which is true" ',condition ,value)))
           (process-pass ',condition)))))

(defmacro is-every (predicate &body clauses)
  "Check (PREDICATE EXPECTED ACTUAL) for each clause (EXPECTED ACTUAL . REASON)."
  (if (every #'consp clauses)
      `(progn ,@(loop for (expected actual . reason) in clauses
                      collect `(is (,predicate ,expected ,actual) ,@reason)))
      (progn
        (assert (evenp (length clauses)) () "IS-EVERY: the clauses are lists (EXPECTED ACTUAL . REASON), or an even number of forms.")
        `(progn ,@(loop for (expected actual) on clauses by #'cddr
                        collect `(is (,predicate ,expected ,actual)))))))

(defmacro signals (condition-spec &body body)
  "Check that BODY signals the condition: its type, or a list of the type and FORMAT arguments of the reason for failing."
  (destructuring-bind (condition &rest reason) (if (listp condition-spec) condition-spec (list condition-spec))
    (let ((block (gensym "SIGNALS")))
      `(block ,block
         (handler-bind ((,condition (lambda (condition)
                                      (declare (ignore condition))
                                      (process-pass ',condition)
                                      (return-from ,block t))))
           (block nil ,@body))
         (process-failure ',condition ,(reason-form reason `(format nil "Failed to signal a ~S" ',condition)))
         nil))))

(defmacro finishes (&body body)
  "Check that BODY returns in the ordinary way; its value."
  (let ((finished (gensym "FINISHED")))
    `(let ((,finished nil))
       (unwind-protect (prog1 (progn ,@body) (setf ,finished t))
         (if ,finished
             (process-pass ',(cons 'progn body))
             (process-failure ',(cons 'progn body) "Test didn't finish"))))))

(defmacro pass (&rest message-args)
  "A check that passes."
  `(add-result 'test-passed ,@(when message-args `(:reason (format nil ,@message-args)))))

(defmacro fail (&rest message-args)
  "A check that fails."
  `(process-failure nil ,(reason-form message-args "no reason given")))

(defmacro skip (&rest reason)
  "Note that something is not tested, and why."
  `(progn (show "s")
          (add-result 'test-skipped :reason ,(reason-form reason "no reason given"))))
