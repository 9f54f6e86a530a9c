(progn (asdf:load-system :cl-transforms-stamped) (in-package :cl-transforms-stamped) 'in)
;=> COMMON-LISP-USER::IN

(defvar *v* (make-3d-vector 1 2.5d0 -3))
;=> \*V\*

(defvar *q* (euler->quaternion :az (/ pi 2)))
;=> \*Q\*

(defvar *pose* (make-pose-stamped "map" 12.5d0 *v* *q*))
;=> \*POSE\*

*pose*
;=> #<POSE-STAMPED FRAME-ID: "map", STAMP: 12\.5d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(defvar *transform* (make-transform-stamped "map" "/base" 3.25d0 *v* *q*))
;=> \*TRANSFORM\*

*transform*
;=> #<TRANSFORM-STAMPED FRAME-ID: "map", CHILD-FRAME-ID: "/base", STAMP: 3\.25d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(make-point-stamped "hand" 0.0 *v*)
;=> #<POINT-STAMPED FRAME-ID: "hand" STAMP: 0\.0 V: \(1\.0d0 2\.5d0 -3\.0d0\)>

(make-vector-stamped "hand" 1 *v*)
;=> #<VECTOR-STAMPED FRAME-ID: "hand" STAMP: 1 V: \(1\.0d0 2\.5d0 -3\.0d0\)>

(list (frame-id *transform*) (child-frame-id *transform*) (stamp *transform*) (translation *transform*))
;=> \("map" "/base" 3\.25d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)>\)

(mapcar #'unslash-frame '("/map" "map/" "/a/b/" " x " nil))
;=> \("map" "map" "a/b" "x" NIL\)

(list (resolve-frame "robot" "base") (resolve-frame "/robot/" "/base"))
;=> \("robot/base" "robot/base"\)

(transform->transform-stamped "a" "b" 1.5d0 (make-transform *v* *q*))
;=> #<TRANSFORM-STAMPED FRAME-ID: "a", CHILD-FRAME-ID: "b", STAMP: 1\.5d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(pose->pose-stamped "a" 1.5d0 (make-pose *v* *q*))
;=> #<POSE-STAMPED FRAME-ID: "a", STAMP: 1\.5d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(pose-stamped->pose *pose*)
;=> #<POSE #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(point->point-stamped "a" 2 *v*)
;=> #<POINT-STAMPED FRAME-ID: "a" STAMP: 2 V: \(1\.0d0 2\.5d0 -3\.0d0\)>

(vector->vector-stamped "a" 2 *v*)
;=> #<VECTOR-STAMPED FRAME-ID: "a" STAMP: 2 V: \(1\.0d0 2\.5d0 -3\.0d0\)>

(copy-pose-stamped *pose* :origin (make-3d-vector 0 0 1) :stamp 1.0d0)
;=> #<POSE-STAMPED FRAME-ID: "map", STAMP: 1\.0d0 #<3D-VECTOR \(0\.0d0 0\.0d0 1\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(list (eq *pose* (ensure-pose-stamped *pose* "x" 1)) (ensure-pose-stamped (make-pose *v* *q*) "x" 1))
;=> \(T #<POSE-STAMPED FRAME-ID: "x", STAMP: 1 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>\)

(ensure-pose-stamped *transform*)
;=> #<POSE-STAMPED FRAME-ID: "map", STAMP: 3\.25d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(ensure-pose-stamped *transform* "other" 9.5d0)
;=> #<POSE-STAMPED FRAME-ID: "other", STAMP: 9\.5d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(handler-case (ensure-pose-stamped (make-pose *v* *q*)) (error (e) (princ-to-string e)))
;=> "Cannot convert POSE into POSE-STAMPED without `frame-id' and `stamp'\."

(handler-case (ensure-pose-stamped 5) (error (e) (typep e 'error)))
;=> T

(handler-case (transform-stamped->pose-stamped *transform*) (error (e) (typep e 'error)))
;=> #<POSE-STAMPED FRAME-ID: "/base", STAMP: 3\.25d0 #<3D-VECTOR \(0\.0d0 0\.0d0 0\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.0d0 1\.0d0\)>>

(list (type-of (to-msg *v*)) (type-of (to-msg *q*)) (type-of (to-msg (make-pose *v* *q*))) (type-of (to-msg *transform*)) (type-of (to-msg *pose*)))
;=> \(GEOMETRY_MSGS-MSG:VECTOR3 GEOMETRY_MSGS-MSG:QUATERNION GEOMETRY_MSGS-MSG:POSE GEOMETRY_MSGS-MSG:TRANSFORMSTAMPED GEOMETRY_MSGS-MSG:POSESTAMPED\)

(to-msg *v*)
;=> \[GEOMETRY_MSGS-MSG:VECTOR3 X: 1\.0d0 Y: 2\.5d0 Z: -3\.0d0\]

(to-msg (make-point-stamped "hand" 2.5d0 *v*))
;=> \[GEOMETRY_MSGS-MSG:POINTSTAMPED HEADER: \(STD_MSGS-MSG:HEADER \(:SEQ \. 0\) \(:STAMP \. 2\.5d0\) \(:FRAME_ID \. "hand"\)\) POINT: \(GEOMETRY_MSGS-MSG:POINT \(:X \. 1\.0d0\) \(:Y \. 2\.5d0\) \(:Z \. -3\.0d0\)\)\]

(type-of (to-msg (list *transform* *transform*)))
;=> \(SIMPLE-VECTOR 2\)

(to-msg nil)
;=> #\(\)

(make-point-msg *v*)
;=> \[GEOMETRY_MSGS-MSG:POINT X: 1\.0d0 Y: 2\.5d0 Z: -3\.0d0\]

(type-of (make-pose-stamped-msg (make-pose *v* *q*) "map" 1.0d0))
;=> GEOMETRY_MSGS-MSG:POSESTAMPED

(roslisp:with-fields ((frame (frame_id header)) (stamp (stamp header)) (y (y point))) (pose-stamped->point-stamped-msg *pose*) (list frame stamp y))
;=> \("map" 12\.5d0 2\.5d0\)

(from-msg (to-msg *transform*))
;=> #<TRANSFORM-STAMPED FRAME-ID: "map", CHILD-FRAME-ID: "/base", STAMP: 3\.25d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(from-msg (to-msg *pose*))
;=> #<POSE-STAMPED FRAME-ID: "map", STAMP: 12\.5d0 #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(from-msg (to-msg (make-point-stamped "hand" 2.5d0 *v*)))
;=> #<POINT-STAMPED FRAME-ID: "hand" STAMP: 2\.5d0 V: \(1\.0d0 2\.5d0 -3\.0d0\)>

(from-msg (to-msg (make-pose *v* *q*)))
;=> #<POSE #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(from-msg (to-msg (make-transform *v* *q*)))
;=> #<TRANSFORM #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(from-msg (make-point-msg *v*))
;=> #<3D-VECTOR \(1\.0d0 2\.5d0 -3\.0d0\)>

(stamp (from-msg (restamp-msg (to-msg *transform*) 77.5d0)))
;=> 77\.5d0

(handler-case (from-msg (make-header-msg 1.0d0 "map")) (error (e) (typep e 'error)))
;=> T

(handler-case (to-msg "text") (error (e) (typep e 'error)))
;=> T

(handler-case (to-msg (make-vector-stamped "hand" 1 *v*)) (:no-error (message) (type-of message)))
;=> GEOMETRY_MSGS-MSG:VECTOR3

(handler-case (make-point-msg 5) (error (e) (typep e 'type-error)))
;=> T

(let ((warned 0)) (handler-bind ((warning (lambda (w) (incf warned) (muffle-warning w)))) (list (type-of (make-stamped-transform "a" "b" 1 *v* *q*)) warned)))
;=> \(TRANSFORM-STAMPED 1\)

(let ((text nil)) (handler-bind ((warning (lambda (w) (setf text (princ-to-string w)) (muffle-warning w)))) (transform->stamped-transform "a" "b" 1 (make-transform *v* *q*)) text))
;=> "TRANSFORM->STAMPED-TRANSFORM is deprecated\. Use TRANSFORM->TRANSFORM-STAMPED instead\."

(handler-case (error 'lookup-error :description "no such frame") (transform-stamped-error (e) (list (type-of e) (error-description e) (princ-to-string e))))
;=> \(LOOKUP-ERROR "no such frame" "no such frame"\)

(mapcar (lambda (name) (subtypep name 'transform-stamped-error)) '(connectivity-error lookup-error extrapolation-error invalid-argument-error timeout-error))
;=> \(T T T T T\)

(handler-case (lookup-transform 5 "a" "b") (error (e) (typep e 'error)))
;=> T

(mapcar (lambda (class) (not (null (find-class class nil)))) '(frame stamped transform-stamped pose-stamped point-stamped vector-stamped stamped-transform))
;=> \(NIL T T T T T T\)

(list (typep *pose* 'stamped) (typep *pose* 'pose) (typep *transform* 'transform) (typep (make-point-stamped "a" 0 *v*) '3d-vector))
;=> \(T T T T\)
