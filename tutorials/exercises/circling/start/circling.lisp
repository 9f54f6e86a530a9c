(in-package :tut)

(def-fact-group circling (motion-grounding matching-process-module available-process-module)
  (<- (cpm:available-process-module turtlesim-circling)))

(def-process-module turtlesim-circling (motion-designator)
  (print (reference motion-designator)))
