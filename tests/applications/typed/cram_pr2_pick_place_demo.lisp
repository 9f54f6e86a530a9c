(asdf:load-system :cram-pr2-pick-place-demo)
;=> T

(in-package :demo)
;=> #<PACKAGE "CRAM-PR2-PICK-PLACE-DEMO">

(roslisp-utilities:startup-ros)
;=> NIL

(and (defmethod exe:generic-perform :before (designator) designator) t)
;=> T

(spawn-objects-on-sink-counter)
;=> NIL

(urdf-proj:with-simulated-robot (go-to-sink-or-island :island) (go-to-sink-or-island))
;=> NIL

(urdf-proj:with-simulated-robot (pick-object :cup :left))
;=> NIL

(urdf-proj:with-simulated-robot
  (place-object (cl-transforms-stamped:pose->pose-stamped "map" 0.0 (btr:ensure-pose '((-0.79 1.35 0.9) (0 0 0.7071 0.7071)))) :left))
;=> NIL

(lies :cup-1)
;=> \(-0\.79 1\.35 0\.9\)

(spawn-objects-on-sink-counter-randomly)
;=> NIL

(urdf-proj:with-simulated-robot (initialize-or-finalize))
;=> NIL

(urdf-proj:with-simulated-robot (demo-random nil))
;=> \(\(DEMO-RANDOM\)\)

(list (btr:attached-objects (btr:get-robot-object))
      (loop for name in '(:bowl-1 :spoon-1 :cup-1 :milk-1 :breakfast-cereal-1)
            for (x y z) = (lies name)
            always (and (< x -0.4) (< 0 y 3) (< 0.84 z))))
;=> \(NIL T\)

(btr:joint-state (btr:get-environment-object) "sink_area_left_upper_drawer_main_joint")
;=> 0\.0d?0?

(demo-hard-coded)
;=> (?s)manipulation_pose_unreachable: .*0\.6000000.* is unreachable for EE\.
