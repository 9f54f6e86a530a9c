(import cramhy [SimplePlanFailure])
(defclass DryPen [SimplePlanFailure])
(setv pen [2])
(defn dip-pen []
  (sleep 0.2)
  (when (> (get pen 0) 0)
    (-= (get pen 0) 1)
    (fail (DryPen))))
(import turtlesim-in-hy.control-turtlesim [send-vel-cmd])
(defn draw-line []
  (with-retry-counters [[again 3]]
    (with-failure-handling
      [[DryPen [failure]
         (do-retry again
           (retry))]]
      (dip-pen)))
  (send-vel-cmd 2 0)
  (sleep 1))
