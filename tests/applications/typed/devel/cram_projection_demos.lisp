(asdf:load-system :cram-projection-demos)
;=> T

(in-package :demos)
;=> #<PACKAGE "CRAM-PROJECTION-DEMOS">

(roslisp-utilities:startup-ros)
;=> NIL

(household-demo :object-list '(:milk))
;=> NIL

(list (btr:attached-objects (btr:get-robot-object)) (btr:attached-objects (btr:get-environment-object)))
;=> \(NIL \(\(:MILK-1 "sink_area_trash_drawer_main"\)\)\)

(stands-in :milk-1 "sink_area_trash_drawer_main")
;=> T

(loop for joint in '("iai_fridge_door_joint" "sink_area_trash_drawer_main_joint")
      always (< (abs (btr:joint-state (btr:get-environment-object) joint)) 0.01))
;=> T
