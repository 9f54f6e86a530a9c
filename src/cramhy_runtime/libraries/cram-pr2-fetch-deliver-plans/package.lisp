;;;; pr2-fd-plans: plans for searching, fetching, delivering and transporting. Each plan copes with what the plans below it could not do, by
;;;; trying another place, arm or grasp, so often; then it fails with a failure of its own. Nothing is exported: plans are called by
;;;; performing actions.

(defpackage #:cram-pr2-fetch-deliver-plans
  (:nicknames #:pr2-fd-plans)
  (:use #:common-lisp #:cram-prolog))

(in-package #:cram-pr2-fetch-deliver-plans)

(defun next-solution (designator)
  "The next solution of DESIGNATOR, or nil."
  (handler-case (desig:next-solution (desig:current-desig designator))
    (desig:designator-error () nil)))

(defmacro with-other-solutions ((tries topic &rest failures) (next give-up) &body body)
  "Do BODY. After one of FAILURES, which is logged under TOPIC, do NEXT, and where that is true BODY again, TRIES times at most. When NEXT
is nil, and after the last try, GIVE-UP, which signals a failure."
  (let ((left (gensym "LEFT")) (failure (gensym "FAILURE")))
    `(cpl:with-retry-counters ((,left ,tries))
       (cpl:with-failure-handling
           (((or ,@failures) (,failure)
              (roslisp:ros-warn ,topic "~a" ,failure)
              (cpl:do-retry ,left
                (when ,next
                  (roslisp:ros-warn ,topic "Trying something else.")
                  (cpl:retry)))
              ,give-up))
         ,@body))))

(defmacro failing-as ((class &rest initargs) description &rest arguments)
  "Fail with a failure of CLASS, and a text."
  `(cpl:fail ',class ,@initargs :description (format nil ,description ,@arguments)))
