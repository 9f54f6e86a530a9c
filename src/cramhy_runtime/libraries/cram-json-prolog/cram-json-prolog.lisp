;;;; json-prolog: how programs ask KnowRob, whose Prolog runs in a process of its own. There is no KnowRob here, so no query has an answer,
;;;; and nothing that is asserted is kept. The first query of a session says so.

(defpackage #:json-prolog
  (:use #:common-lisp)
  (:export #:*service-namespace* #:check-connection #:prolog #:prolog-1 #:prolog-simple #:prolog-simple-1 #:finish-query #:json-prolog
           #:wait-for-prolog-service #:with-type-atoms #:init-type-atoms #:clear-type-atoms #:replace-complex-types
           #:start-prolog-server))

(in-package #:json-prolog)

(defvar *service-namespace* "/json_prolog" "Where the services of KnowRob's Prolog would be.")

(defvar *told* nil "Whether this session has heard that nobody answers.")

(defun no-answers ()
  "No solution, nil; the first time in a session with a line that says why."
  (unless *told*
    (setf *told* t)
    (roslisp:ros-warn (json-prolog)
                      "There is no KnowRob here: queries to json_prolog have no answers, and it keeps nothing. This is said once."))
  nil)

(defun prolog (query &key (prologify t) (lispify nil) (mode 0) (package *package*))
  "The solutions of QUERY, an expression as `cram-prolog:prolog' takes it: none, nil."
  (declare (ignore query prologify lispify mode package))
  (no-answers))

(defun prolog-1 (query &key (mode 0) (prologify t) (lispify nil) (package *package*))
  "As `prolog', for the first solution."
  (declare (ignore query prologify lispify mode package))
  (no-answers))

(defun prolog-simple (query &key (mode 0) (lispify nil) (package *package*))
  "The solutions of QUERY, a string with the text of a query: none, nil."
  (declare (ignore query mode lispify package))
  (no-answers))

(defun prolog-simple-1 (query &key (lispify nil) (mode 0) (package *package*))
  "As `prolog-simple', for the first solution."
  (declare (ignore query mode lispify package))
  (no-answers))

(defun finish-query (result)
  "RESULT: there is no query to close."
  result)

(defun check-connection ()
  "Whether KnowRob answers: nil."
  nil)

(defun wait-for-prolog-service (&optional timeout)
  "Whether KnowRob answered within TIMEOUT seconds: nil, at once."
  (declare (ignore timeout))
  nil)

(defun start-prolog-server (namespace &key (package *package*))
  "Nothing: nobody can ask the facts of this session through NAMESPACE."
  (declare (ignore namespace package))
  nil)

(defmacro with-type-atoms (&body body)
  "BODY: types of terms matter only to who answers."
  `(progn ,@body))

(defun init-type-atoms ()
  nil)

(defun clear-type-atoms ()
  nil)

(defun replace-complex-types (expression)
  "EXPRESSION."
  expression)

(cram-prolog:def-prolog-handler json-prolog (bindings query &rest options)
  (declare (ignore bindings query options))
  (no-answers))
