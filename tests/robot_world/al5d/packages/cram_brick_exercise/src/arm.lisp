;;;; The habits of such packages: subscribers made by startup-ros, a publisher that waits for its subscriber in a loop, a sleep after each
;;;; command, the gripper kept in a special variable, poses of cl-transforms from which Euler's angles are taken.

(in-package :bex)

(defvar *image* (make-fluent :name :image))
(defvar *states* (make-fluent :name :states))
(defvar *state-sub* nil)
(defvar *image-sub* nil)
(defvar *pub* nil)
(defvar *gripper* 0.03175)
(defvar *pause* 3)

(defun init-subscribers ()
  (setf *image-sub* (subscribe "lynxmotion_al5d/al5d_external_vision/image_raw" "sensor_msgs/Image"
                               (lambda (message) (setf (value *image*) message)))
        *state-sub* (subscribe "lynxmotion_al5d/joint_states" "sensor_msgs/JointState"
                               (lambda (message) (setf (value *states*) message)))))

(defun init-publisher ()
  (setf *pub* (advertise "/lynxmotion_al5d/joints_positions/command" "std_msgs/Float64MultiArray")))

(defun drop-all ()
  (setf *pub* nil *state-sub* nil *image-sub* nil))

(register-ros-init-function init-subscribers)
(register-ros-init-function init-publisher)
(register-ros-cleanup-function drop-all)

(defun joint (wanted)
  (with-fields (name position) (value *states*)
    (aref position (position wanted name :test #'string-equal))))

(defun send-joints (angles)
  (loop until (plusp (num-subscribers *pub*)) do (sleep 0.0001))
  (publish *pub* (make-message "std_msgs/Float64MultiArray" :data (map 'vector #'identity (append angles (list *gripper*)))))
  (sleep *pause*))

(defun angles-for (pose)
  (let* ((x (x (origin pose))) (y (y (origin pose))) (z (- (z (origin pose)) 0.07))
         (yaw (sixth (quaternion->euler (orientation pose))))
         (base (atan x y)) (away (sqrt (+ (* x x) (* y y)))) (far (+ (* away away) (* z z)))
         (shoulder (+ (atan z away) (acos (/ (+ far (* 0.146d0 0.146d0) (* -0.187d0 0.187d0)) (* 2 0.146d0 (sqrt far))))))
         (elbow (- (acos (/ (- far (* 0.146d0 0.146d0) (* 0.187d0 0.187d0)) (* 2 0.146d0 0.187d0))))))
    (list base shoulder elbow (- (/ pi -2) elbow shoulder) (- (/ pi 2) yaw base))))

(def-cram-function close-to (width)
  (setf *gripper* width)
  (send-joints (mapcar #'joint '("Joint1" "Joint2" "Joint3" "Joint4" "Joint5"))))

(def-cram-function go-to-pose (pose)
  (send-joints (angles-for pose)))
