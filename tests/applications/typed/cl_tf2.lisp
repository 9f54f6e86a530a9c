(progn (asdf:load-system :cl-tf2) (asdf:load-system :tf2_msgs-msg))
;=> T

(progn (defpackage :looking (:use :cl :cl-tf2)) (in-package :looking))
;=> #<PACKAGE "LOOKING">

(roslisp:start-ros-node "looking")
;=> 0

(defvar *heard* nil)
;=> \*HEARD\*

(progn (roslisp:subscribe "/tf" "tf2_msgs/TFMessage" (lambda (message) (push message *heard*))) 'subscribed)
;=> SUBSCRIBED

(defvar *broadcaster* (make-transform-broadcaster))
;=> \*BROADCASTER\*

(list (type-of *broadcaster*) (typep *broadcaster* 'transform-broadcaster))
;=> \(TRANSFORM-BROADCASTER T\)

(defun turned (stamp x) (make-transform-stamped "/map" "base" stamp (make-3d-vector x 2 0) (euler->quaternion :az (/ pi 2))))
;=> TURNED

(progn (roslisp:wait-duration 0.5) (send-transform *broadcaster* (turned 10d0 1)) (roslisp:wait-duration 0.5) (length *heard*))
;=> 1

(let ((one (elt (roslisp:msg-slot-value (first *heard*) :transforms) 0))) (list (roslisp:msg-slot-value one :child_frame_id) (from-msg one)))
;=> \("base" #<TRANSFORM-STAMPED FRAME-ID: "/map", CHILD-FRAME-ID: "base", STAMP: 10\.0d0 #<3D-VECTOR \(1\.0d0 2\.0d0 0\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>\)

(progn (send-transform *broadcaster* (turned 11d0 2) (turned 12d0 3)) (roslisp:wait-duration 0.5) (length (roslisp:msg-slot-value (first *heard*) :transforms)))
;=> 2

(handler-case (send-transform *broadcaster* 5) (error (e) (typep e 'error)))
;=> T

(defvar *static* (make-transform-broadcaster :topic "/tf_static" :static t))
;=> \*STATIC\*

(progn (send-transform *static* (turned 0d0 4)) (let ((late nil)) (roslisp:subscribe "/tf_static" "tf2_msgs/TFMessage" (lambda (message) (push message late))) (roslisp:wait-duration 1) (mapcar (lambda (message) (x (translation (from-msg (elt (roslisp:msg-slot-value message :transforms) 0))))) late)))
;=> \(4\.0d0\)

(handler-case (make-instance 'buffer-client :timeout 0.5) (timeout-error (e) (princ-to-string e)))
;=> "Waiting for action server timed out\."

(progn (defvar *asked* nil) (defvar *code* 0) (defvar *status-pub* (roslisp:advertise "tf2_buffer_server/status" "actionlib_msgs/GoalStatusArray")) (defvar *result-pub* (roslisp:advertise "tf2_buffer_server/result" "tf2_msgs/LookupTransformActionResult")) 'advertised)
;=> ADVERTISED

(progn (roslisp:advertise "tf2_buffer_server/feedback" "tf2_msgs/LookupTransformActionFeedback") (roslisp:subscribe "tf2_buffer_server/goal" "tf2_msgs/LookupTransformActionGoal" (lambda (goal) (roslisp:with-fields ((id (id goal_id)) (target (target_frame goal)) (source (source_frame goal)) (time (source_time goal)) (fixed (fixed_frame goal)) (advanced (advanced goal))) goal (push (list target source time fixed advanced) *asked*) (roslisp:publish *result-pub* (roslisp:make-msg "tf2_msgs/LookupTransformActionResult" (id goal_id status) id (status status) 3 (error error result) *code* (error_string error result) (format nil "code ~a" *code*) (transform result) (to-msg (turned (if (zerop time) 10d0 time) 1))))))) 'serving)
;=> SERVING

(progn (defvar *beating* t) (defvar *heart* (sb-thread:make-thread (lambda () (loop while *beating* do (roslisp:publish *status-pub* (roslisp:make-msg "actionlib_msgs/GoalStatusArray")) (roslisp:wait-duration 0.2))))) 'beating)
;=> BEATING

(defvar *client* (make-instance 'buffer-client :timeout 5.0))
;=> \*CLIENT\*

(lookup-transform *client* "/map" "/base" :time 10d0 :timeout 2)
;=> #<TRANSFORM-STAMPED FRAME-ID: "/map", CHILD-FRAME-ID: "base", STAMP: 10\.0d0 #<3D-VECTOR \(1\.0d0 2\.0d0 0\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(first *asked*)
;=> \("map" "base" 10\.0d0 "" NIL\)

(progn (lookup-transform *client* "map" "base" :timeout 2) (first *asked*))
;=> \("map" "base" 0\.0d0 "" NIL\)

(progn (lookup-transform *client* "map" "base" :timeout 2 :time 11d0 :target-time 12d0 :fixed-frame "/odom") (first *asked*))
;=> \("map" "base" 11\.0d0 "odom" T\)

(transform-pose-stamped *client* :target-frame "map" :pose (make-pose-stamped "base" 10d0 (make-3d-vector 1 0 0) (make-identity-rotation)) :timeout 2)
;=> #<POSE-STAMPED FRAME-ID: "map", STAMP: 10\.0d0 #<3D-VECTOR \(1\.0000000000000002d0 3\.0d0 0\.0d0\)> #<QUATERNION \(0\.0d0 0\.0d0 0\.7071067811865475d0 0\.7071067811865476d0\)>>

(transform-point-stamped *client* :target-frame "map" :point (make-point-stamped "base" 10d0 (make-3d-vector 1 0 0)) :timeout 2)
;=> #<POINT-STAMPED FRAME-ID: "map" STAMP: 10\.0d0 V: \(1\.0000000000000002d0 3\.0d0 0\.0d0\)>

(first *asked*)
;=> \("map" "base" 10\.0d0 "" NIL\)

(handler-case (transform-pose-stamped *client* :target-frame 'map :pose (make-pose-stamped "base" 10d0 (make-3d-vector 1 0 0) (make-identity-rotation))) (error (e) (typep e 'type-error)))
;=> T

(handler-case (transform-point-stamped *client* :target-frame "map" :point 5) (error (e) (typep e 'type-error)))
;=> T

(progn (setf *code* 1) (handler-case (lookup-transform *client* "map" "base" :timeout 2) (error (e) (list (type-of e) (princ-to-string e)))))
;=> \(LOOKUP-ERROR "code 1"\)

(loop for code from 2 to 6 collect (progn (setf *code* code) (handler-case (lookup-transform *client* "map" "base" :timeout 2) (error (e) (list (type-of e) (princ-to-string e))))))
;=> \(\(CONNECTIVITY-ERROR "code 2"\) \(EXTRAPOLATION-ERROR "code 3"\) \(INVALID-ARGUMENT-ERROR "code 4"\) \(TIMEOUT-ERROR "code 5"\) \(TRANSFORM-STAMPED-ERROR "code 6"\)\)

(progn (setf *code* 1) (handler-case (transform-point-stamped *client* :target-frame "map" :point (make-point-stamped "base" 10d0 (make-3d-vector 1 0 0)) :timeout 2) (lookup-error (e) (princ-to-string e))))
;=> "code 1"

(progn (setf *beating* nil *code* 0) 'quiet)
;=> QUIET
