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

(flet ((from-there-p (x z)
         (flet ((at (x y z) (cl-transforms-stamped:make-pose-stamped "map" 0.0 (cl-transforms:make-3d-vector x y z) (cl-transforms:make-identity-rotation))))
           (and (validate-location-designator-solution
                 (make-designator :location `((:reachable-for cram-pr2-description:pr2) (:pose ,(at 1 1 0.8)))) (at x 1 z))
                t))))
  (list (from-there-p 0.5 0.0) (from-there-p 0.9 0.0) (from-there-p 0.5 0.3)))
;=> \(T NIL NIL\)
