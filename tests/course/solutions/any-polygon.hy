(defn draw-polygon [corners]
  (for [i (range corners)]
    (ahead 1)
    (left (/ 360 corners))))
