(define-test no-pose
  (assert-error 'error (angle-to 1 7 "here")))
