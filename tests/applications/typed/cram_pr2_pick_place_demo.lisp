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

(list (desig:desig-prop-value (pose-list->desig '((1 2 3) (0 0 0 1))) :pose)
      (funcall (make-restricted-area-cost-function) 0.5 0.0)
      (funcall (make-restricted-area-cost-function) 1.5 0.0)
      (costmap:costmap-generator-name->score 'restricted-area))
;=> \(#<CL-TRANSFORMS-STAMPED:POSE-STAMPED FRAME-ID: "map", .*\(1\.0d0 2\.0d0 3\.0d0\).*>> 1\.0 0\.0 5\)

(generate-training-data)
;=> NIL

(mapcar #'btr:name (btr:objects btr:*current-bullet-world*))
;=> \(:FLOOR :KITCHEN CRAM-PR2-DESCRIPTION:PR2\)
