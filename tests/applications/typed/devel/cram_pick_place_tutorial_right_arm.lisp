(ros-load:load-system "cram_pick_place_tutorial" :cram-pick-place-tutorial)
;=> T

(in-package :pp-tut)
;=> #<PACKAGE "CRAM-PICK-PLACE-TUTORIAL">

(roslisp-utilities:startup-ros)
;=> NIL

(spawn-object '((-1.6 -0.9 0.82) (0 0 0 1)))
;=> NIL

(with-simulated-robot
  (let ((?to (make-pose "map" '((-1.8547 -0.381 0) (0 0 -0.7071 0.7071)))) (?look (make-pose "base_footprint" '((0.65 0.08 0.76) (0 0 0 1)))))
    (cpl:par (perform (a motion (type moving-torso) (joint-angle 0.3)))
             (park-arms)
             (perform (an action (type going) (target (a location (pose ?to))))))
    (perform (an action (type looking) (target (a location (pose ?look)))))
    (let ((?bottle (perform (an action (type detecting) (object (an object (type bottle)))))))
      (perform (an action (type picking-up) (arm (right)) (right-grasp left-side) (object ?bottle)))
      (park-arm :right)
      (get-obj-name ?bottle))))
;=> BOTTLE-1

(mapcar #'car (btr:attached-objects (btr:get-robot-object)))
;=> \(BOTTLE-1\)
