(define-test to-the-left
  (assert-number-equal (/ pi 2) (angle-to 1 7 (turtle-at 1 1 0.0))))
