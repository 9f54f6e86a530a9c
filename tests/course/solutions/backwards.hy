(defn negative [number]
  (- number))
(def-fact-group reversing [motion-grounding]
  (<- (desig:motion-grounding ?desig ["drive" ?motion])
    (desig-prop ?desig (type reversing))
    (desig-prop ?desig (speed ?speed))
    (lisp-fun negative ?speed ?back)
    (lisp-fun TurtleMotion :speed ?back ?motion)))
