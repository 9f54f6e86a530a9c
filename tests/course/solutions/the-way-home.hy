(defn go-home []
  (top-level (drive-to 5.5 5.5)))
