(defn drive-square []
  (for [i (range 4)]
    (ahead 2)
    (turn-left)))
