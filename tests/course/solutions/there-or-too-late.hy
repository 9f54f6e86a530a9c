(defn reach [x y seconds]
  (top-level
    (with-failure-handling
      [[simple-plan-failure [failure]
         (leave "too late")]]
      (pursue
        (do (sleep seconds) (fail "Too late."))
        (drive-to x y))
      "there")))
