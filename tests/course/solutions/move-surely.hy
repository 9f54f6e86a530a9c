(import turtlesim-in-hy.simple-plans [move-to rotate-to])
(defn move-surely [goal]
  (rotate-to goal)
  (move-to goal))
