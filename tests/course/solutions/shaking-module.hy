(def-process-module turtlesim-shaking [motion-designator]
  (setv [command motion] (reference motion-designator))
  (send-vel-cmd 0 motion.angle)
  (wait-duration 1)
  (send-vel-cmd 0 (- motion.angle))
  (wait-duration 1))
