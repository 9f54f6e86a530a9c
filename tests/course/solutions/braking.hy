(def-fact-group my-motions [motion-grounding]
  (<- (desig:motion-grounding ?desig ["drive" ?motion])
    (desig-prop ?desig (type braking))
    (lisp-fun TurtleMotion ?motion)))
