;;;; Plans for picking up and placing with a mobile robot, and the actions that stand for them.
;;;;
;;;; A plan performs motions, copes with the failures that it can cope with, and tells the belief state what has changed. Its parameters
;;;; begin with question marks, so that descriptions of designators can name them.

(defpackage #:cram-mobile-pick-place-plans
  (:use #:common-lisp #:cram-prolog)
  (:nicknames #:pp-plans)
  (:export #:move-arms-in-sequence #:park-arms #:release #:grip #:close-gripper #:set-gripper-to-position #:look-at #:go-to-target
           #:pick-up #:place #:perceive))

(in-package #:cram-mobile-pick-place-plans)

(defmacro tell (event &rest initargs)
  "Let the belief state know of an event of the class EVENT. The value is nil."
  `(progn
     (cram-occasions-events:on-event (make-instance ',event ,@initargs))
     nil))

(defmacro with-retries ((failures count topic) body &body finally)
  "Do BODY. On one of FAILURES, which are logged under TOPIC, do it again, COUNT times at most, and then FINALLY; where FINALLY does not
return, the failure goes on to the caller."
  (let ((failure (gensym "FAILURE")) (again (gensym "AGAIN")))
    `(cpl:with-retry-counters ((,again ,count))
       (cpl:with-failure-handling
           (((or ,@failures) (,failure)
              (roslisp:ros-warn ,topic "~a" ,failure)
              (cpl:do-retry ,again
                (roslisp:ros-warn ,topic "Retrying.")
                (cpl:retry))
              ,@finally))
         ,body))))
