(ros-load:load-system "cram_cup_demo" :cram-cup-demo)
;=> T

(in-package :cup-demo)
;=> #<PACKAGE "CRAM-CUP-DEMO">

(roslisp-utilities:startup-ros)
;=> NIL

(place-cup-on-counter)
;=> NIL

(urdf-proj:with-simulated-robot (bring-cup))
;=> :CUP-1

(lies :cup-1)
;=> \(-0\.8 1\.3\d* 0\.\d+\)

(roslisp-utilities:startup-ros)
;=> NIL

(pr2-proj:with-simulated-robot (perform (an action (type moving-torso) (joint-angle upper-limit))))
;=> NIL

(loop with names = (format nil "~s" (list-location-validation-functions))
      for name in '("ROBOT-LOCATION-ON-FLOOR" "REACHABLE-LOCATION-VALIDATOR" "VISIBLE-LOCATION-VALIDATOR")
      always (integerp (search name names)))
;=> T
