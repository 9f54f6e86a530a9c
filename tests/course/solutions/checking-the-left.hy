(defn test-to-the-left []
  (assert (< (abs (- (/ pi 2) (angle-to 1 7 (turtle-at 1 1 0.0)))) 0.00001)))
