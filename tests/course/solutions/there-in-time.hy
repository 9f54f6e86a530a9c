(defn there-in-time [goal seconds]
  (pursue
    (move-to goal)
    (sleep seconds)))
