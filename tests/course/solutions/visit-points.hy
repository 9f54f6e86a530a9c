(defn visit [points]
  (for [[x y] points]
    (let [goal (make-3d-vector x y 0)]
      (rotate-to goal)
      (move-to goal))))
