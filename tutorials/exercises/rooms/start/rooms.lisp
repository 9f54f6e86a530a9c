(in-package :tut)

(def-fact-group flat ()
  (<- (neighbours ?one ?other)
    (door ?one ?other)))
