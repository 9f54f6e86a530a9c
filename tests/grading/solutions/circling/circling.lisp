(in-package :tut)

(def-fact-group circling (motion-grounding matching-process-module available-process-module)
  (<- (desig:motion-grounding ?desig (circle ?radius))
    (desig-prop ?desig (:type :circling))
    (desig-prop ?desig (:radius ?radius)))
  (<- (cpm:available-process-module turtlesim-circling))
  (<- (cpm:matching-process-module ?desig turtlesim-circling)
    (desig-prop ?desig (:type :circling))))

(def-process-module turtlesim-circling (motion-designator)
  (destructuring-bind (command radius) (reference motion-designator)
    (ecase command
      (circle
        (let ((pieces 40))
          (dotimes (piece pieces)
            (let ((seconds (/ (* 2 pi radius) pieces)))
              (send-vel-cmd 1 (/ 1 radius))
              (wait-duration seconds))))
        (send-vel-cmd 0 0)))))
