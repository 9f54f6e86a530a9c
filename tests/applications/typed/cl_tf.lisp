(asdf:load-system :cl-tf)
;=> T

(in-package :cl-tf)
;=> .*

(defparameter *tf* (make-instance 'transformer))
;=> \*TF\*

(dotimes (i 31 'set) (let ((stamp (+ 10 (/ i 8d0)))) (set-transform *tf* (make-transform-stamped "map" "base" stamp (make-3d-vector (+ 1 (/ i 8d0)) 2 0) (euler->quaternion :az (/ pi 2)))) (set-transform *tf* (make-transform-stamped "base" "hand" stamp (make-3d-vector 0.5d0 0 1) (make-identity-rotation)))))
;=> SET

(translation (lookup-transform *tf* "map" "base" :time 11.1875d0))
;=> #<3D-VECTOR \(2\.1875d0 2\.0d0 0\.0d0\)>

(translation (lookup-transform *tf* "map" "hand" :time 13.0d0))
;=> #<3D-VECTOR \(4\.0d0 2\.5d0 1\.0d0\)>

(translation (lookup-transform *tf* "hand" "map" :time 10.5d0))
;=> #<3D-VECTOR \(-2\.5000000000000004d0 1\.4999999999999996d0 -1\.0d0\)>

(rotation (lookup-transform *tf* "base" "map" :time 10.5d0))
;=> #<QUATERNION \(-0\.0d0 -0\.0d0 -0\.7071067811865475d0 0\.7071067811865476d0\)>

(let ((found (lookup-transform *tf* "map" "hand" :time 11.1875d0))) (list (frame-id found) (child-frame-id found) (stamp found)))
;=> \("map" "hand" 11\.1875d0\)

(stamp (lookup-transform *tf* "map" "hand"))
;=> 13\.75d0

(can-transform *tf* :target-frame "map" :source-frame "hand" :time 11.1875d0)
;=> T

(can-transform *tf* :target-frame "map" :source-frame "hand" :time 9.0d0)
;=> NIL

(can-transform *tf* :target-frame "map" :source-frame "moon")
;=> NIL

(can-transform *tf* :target-frame "hand" :source-frame "hand")
;=> T

(handler-case (lookup-transform *tf* "map" "hand" :time 9.0d0) (error (e) (type-of e)))
;=> TIMEOUT-ERROR

(handler-case (lookup-transform *tf* "map" "moon") (error (e) (type-of e)))
;=> TIMEOUT-ERROR

(origin (transform-pose *tf* :target-frame "map" :pose (make-pose-stamped "hand" 11.1875d0 (make-3d-vector 1 0 0) (make-identity-rotation))))
;=> #<3D-VECTOR \(2\.1875d0 3\.5d0 1\.0d0\)>

(orientation (transform-pose *tf* :target-frame "map" :pose (make-pose-stamped "hand" 11.1875d0 (make-3d-vector 1 0 0) (make-identity-rotation))))
;=> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>

(transform-point *tf* :target-frame "hand" :point (make-point-stamped "map" 13.0d0 (make-3d-vector 0 0 0)))
;=> #<POINT-STAMPED FRAME-ID: "hand" STAMP: 13\.0d0 V: \(-2\.500000000000001d0 3\.9999999999999996d0 -1\.0d0\)>

(handler-case (transform-pose *tf* :target-frame "map" :pose (make-pose-stamped "moon" 2.0d0 (make-identity-vector) (make-identity-rotation))) (error (e) (type-of e)))
;=> LOOKUP-ERROR

(handler-case (can-transform *tf* :target-frame 'map :source-frame "hand") (error (e) (typep e 'type-error)))
;=> T

(progn (set-transform *tf* (make-transform-stamped "sun" "earth" 10.5d0 (make-3d-vector 1 0 0) (make-identity-rotation))) (handler-case (lookup-transform *tf* "map" "earth" :time 10.5d0) (error (e) (type-of e))))
;=> TIMEOUT-ERROR
