(defpackage :first-lisp-tests (:use :cl :lisp-unit))
(in-package :first-lisp-tests)

(define-test distance-is-the-same-in-both-directions
  (assert-number-equal (tut::distance 1 2 5 7) (tut::distance 5 7 1 2)))

(define-test a-way-there-and-back-is-twice-as-long
  (assert-number-equal (* 2 (tut::way-length '((0 0) (3 4))))
                       (tut::way-length '((0 0) (3 4) (0 0)))))

(define-test a-longer-way-is-longer
  (assert-true (< (tut::way-length '((0 0) (1 1)))
                  (tut::way-length '((0 0) (1 1) (1 3))))))
