(defn put [place]
  (reach place 0.05 0)
  (reach place 0.005 0)
  (reach place 0.005 0.03)
  (reach place 0.05 0.03))
