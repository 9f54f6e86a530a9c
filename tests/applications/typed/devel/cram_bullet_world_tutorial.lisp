(ros-load:load-system "cram_bullet_world_tutorial" :cram-bullet-world-tutorial)
;=> T

(in-package :btw-tut)
;=> #<PACKAGE "CRAM-BULLET-WORLD-TUTORIAL">

(roslisp-utilities:startup-ros)
;=> NIL

(cl-urdf:name (get-kitchen-urdf))
;=> "iai_kitchen"

(move-kitchen-joint)
;=> NIL

(btr:joint-state (btr:get-environment-object) "iai_fridge_door_joint")
;=> 0\.2d0

(add-objects-to-mesh-list)
;=> \(:BLUE-METAL-PLATE :BOTTLE .*

(and (spawn-two-bottles) t)
;=> T

(list (lies 'bottle-1) (lies 'bottle-2))
;=> \(\(-2\.0 -0\.9 0\.82\) \(-0\.8 2\.0 0\.96\)\)

(and (init-projection) t)
;=> T

(roslisp-utilities:startup-ros)
;=> NIL
