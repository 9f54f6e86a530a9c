(defn test-no-pose []
  (try
    (angle-to 1 7 "here")
    (except [Exception]
      (return)))
  (assert False))
