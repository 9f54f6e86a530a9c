(defn drive-for [seconds]
  (top-level
    (pursue
      (drive-to 10 5.5)
      (sleep seconds))))
