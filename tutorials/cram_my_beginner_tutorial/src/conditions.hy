(require cramhy *)
(in-package :tut)

(define-condition out-of-bounds-error (simple-plan-failure)
  ((description :initarg :description
                :initform "Turtle went out of bounds."
                :reader error-description))
  (:report (lambda (condition stream)
             (format stream "~a" (error-description condition)))))
