(ros-load:load-system "cram_pick_place_tutorial" :cram-pick-place-tutorial)
;=> T

(in-package :pp-tut)
;=> #<PACKAGE "CRAM-PICK-PLACE-TUTORIAL">

(roslisp-utilities:startup-ros)
;=> NIL

(cl-urdf:name (get-kitchen-urdf))
;=> "iai_kitchen"

(move-kitchen-joint :joint-angle 0.1d0)
;=> NIL

(spawn-object '((-1.6 -0.9 0.82) (0 0 0 1)))
;=> NIL

(spawn-object '((-0.8 1.5 0.9) (0 0 0 1)) :cup 'cup-1 '(0 1 0))
;=> NIL

(and (member :bottle (list-available-objects)) t)
;=> T

(list (visualize-coordinates 'bottle-1) (visualize-coordinates :bottle) (visualize-coordinates :no-such-thing))
;=> \(.*NIL\)

(make-pose "map" '((1 2 3) (0 0 0 1)))
;=> #<"map" \(\(1\.00000 2\.00000 3\.00000\) \(0\.00000 0\.00000 0\.00000 1\.00000\)\)>

(apply-transformation (inverse-transformation (get-robot-transformation)) (get-current-pose-of-object 'cup-1))
;=> #<CL-TRANSFORMS:POSE .*

(< -0.9 (get-x-of-pose (get-current-pose-of-object 'cup-1)) -0.7 1.4 (get-y-of-pose (get-current-pose-of-object 'cup-1)))
;=> T

(with-simulated-robot (park-arms) (park-arm :left) (look-up-transformation "map" "base_footprint"))
;=> #<"map" "base_footprint" .*

(with-simulated-robot
  (let ((?to (make-pose "map" '((-1.8547 -0.381 0) (0 0 -0.7071 0.7071)))) (?look (make-pose "base_footprint" '((0.65 0.08 0.76) (0 0 0 1)))))
    (cpl:par (perform (a motion (type moving-torso) (joint-angle 0.3)))
             (park-arms)
             (perform (an action (type going) (target (a location (pose ?to))))))
    (perform (an action (type looking) (target (a location (pose ?look)))))
    (let ((?bottle (perform (an action (type detecting) (object (an object (type bottle)))))))
      (perform (an action (type picking-up) (arm (left)) (left-grasp left-side) (object ?bottle)))
      (park-arm :left)
      (get-obj-name ?bottle))))
;=> BOTTLE-1

(with-simulated-robot
  (handle-failure common-fail:navigation-low-level-failure
      ((let ((?inside (make-pose "map" '((1.5 0.4 0) (0 0 0 1))))) (perform (an action (type going) (target (a location (pose ?inside)))))))
    (return :went-elsewhere)))
;=> :WENT-ELSEWHERE
