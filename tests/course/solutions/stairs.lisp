(defun draw-stairs (steps)
  (with-fields (x y) (value *turtle-pose*)
    (draw-simple-shape
     (loop for step from 0 below steps
           collect (list (+ x step) (+ y step 1) 0)
           collect (list (+ x step 1) (+ y step 1) 0)))))
(def-fact-group stairs (action-grounding)
  (<- (desig:action-grounding ?desig (draw-stairs ?steps))
    (desig-prop ?desig (:type :drawing))
    (desig-prop ?desig (:shape :stairs))
    (desig-prop ?desig (:steps ?steps))))
