;;;; ccl: what performs is logged to the knowledge service openEASE. Here nothing is logged and no server is called; the first call of a
;;;; session that would says so. A session keeps what its plans did by itself.

(defpackage #:cram-cloud-logger
  (:nicknames #:ccl)
  (:use #:common-lisp))

(in-package #:cram-cloud-logger)

(defvar *is-client-connected* nil "Whether a server was reached: never.")
(defvar *is-logging-enabled* nil "Whether the application wants actions to be logged.")
(defvar *cloud-logger-client* nil)
(defvar *host* "'https://localhost'" "The address of the server.")
(defvar *cert-path* "" "The file of the server's certificate.")
(defvar *api-key* "" "What the server knows the user by.")
(defvar *prolog-query-save-path* nil "The folder in which queries would be kept.")

(defvar *told* nil "Whether this session has heard that nothing is logged.")

(defun not-logged ()
  "Nil; the first time in a session with a line that says that nothing is logged."
  (unless *told*
    (setf *told* t)
    (roslisp:ros-warn (ccl) "Nothing is logged to the cloud: there is no openEASE here. The episodes of this session keep what its ~
                             plans did: see cram-execution-trace. This is said once."))
  nil)

(defmacro define-unlogged (&rest definitions)
  "Functions with the given names and lambda lists that log nothing: each definition is (name lambda-list documentation)."
  `(progn
     ,@(loop for (name lambda-list documentation) in definitions
             collect `(defun ,name ,lambda-list
                        ,documentation
                        (declare (ignore ,@(set-difference (mapcar (lambda (parameter) (if (consp parameter) (car parameter) parameter))
                                                                   lambda-list)
                                                           lambda-list-keywords)))
                        (not-logged)))))

(define-unlogged
  (connect-to-cloud-logger () "Nil: there is no server, and `*is-client-connected*' stays nil.")
  (init-cloud-logger-client () "As `connect-to-cloud-logger'.")
  (reset-logged-owl () "Nil: nothing was logged.")
  (export-log-to-owl (&optional filename) "Nil: no file is written.")
  (export-belief-state-to-owl (&optional filename) "Nil: no file is written.")
  (start-episode () "Nil: no episode begins in the cloud.")
  (stop-episode () "Nil.")
  (send-prolog-query (prolog-query) "The answer of the server to a query: nil.")
  (send-prolog-query-1 (prolog-query) "The first answer of the server to a query: nil."))
