(in-package :bex)

(def-fact-group brick-designators (motion-grounding action-grounding available-process-module matching-process-module)
  (<- (desig:motion-grounding ?desig (go-to-pose ?pose))
    (desig-prop ?desig (:type :going))
    (desig-prop ?desig (:target ?pose)))
  (<- (desig:motion-grounding ?desig (close-to ?width))
    (desig-prop ?desig (:type :closing))
    (desig-prop ?desig (:distance ?width)))

  (<- (desig:action-grounding ?desig (carry ?from ?to))
    (desig-prop ?desig (:type :carrying))
    (desig-prop ?desig (:from ?from))
    (desig-prop ?desig (:to ?to)))
  (<- (desig:action-grounding ?desig (touring))
    (desig-prop ?desig (:type :touring)))

  (<- (available-process-module brick-arm))
  (<- (matching-process-module ?desig brick-arm)
    (desig-prop ?desig (:type :going)))
  (<- (matching-process-module ?desig brick-arm)
    (desig-prop ?desig (:type :closing))))

(defun tour (designator)
  (with-desig-props (corner) designator
    (when corner
      (loop for side from -1 to 1
            collect (make-pose (make-3d-vector (* side 0.05 corner) 0.18 0.2) (make-identity-rotation))))))

(register-location-generator 5 tour)
