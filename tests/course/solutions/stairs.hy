(import turtlesim-in-hy.control-turtlesim [turtle-pose])
(def-cram-function draw-stairs [steps]
  (with-fields [x y] turtle-pose.value
    (for [step (range steps)]
      (draw-simple-shape [[(+ x step) (+ y step 1) 0] [(+ x step 1) (+ y step 1) 0]]))))
(def-fact-group stairs [action-grounding]
  (<- (desig:action-grounding ?desig [draw-stairs ?steps])
    (desig-prop ?desig (type drawing))
    (desig-prop ?desig (shape stairs))
    (desig-prop ?desig (steps ?steps))))
