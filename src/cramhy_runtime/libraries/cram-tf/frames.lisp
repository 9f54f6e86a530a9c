;;;; Frames: their names, which the robot's description tells when the node starts, and where things are in them.

(in-package #:cram-tf)

(defvar *transformer* nil
  "What knows where frames are: a transformer of CL-TF. A listener to /tf, once the node has started.")

(defvar *tf-default-timeout* 4.0
  "Seconds to wait for a transform.")

(defvar *fixed-frame* nil
  "The frame of the room, \"map\".")

(defvar *odom-frame* nil)
(defvar *robot-base-frame* nil)
(defvar *robot-torso-frame* nil)
(defvar *robot-torso-joint* nil)
(defvar *robot-left-tool-frame* nil)
(defvar *robot-right-tool-frame* nil)

(defun told (variable goal)
  "The value of VARIABLE in what the robot's description says to GOAL, or nil."
  (let ((solution (lazy-car (prolog `(and (robot ?robot) ,goal)))))
    (when solution
      (let ((value (var-value variable solution)))
        (unless (is-var value) value)))))

(defun set-frames ()
  "Let the variables name the frames of the robot whose description is loaded."
  (setf *fixed-frame* "map"
        *odom-frame* (told '?frame '(robot-odom-frame ?robot ?frame))
        *robot-base-frame* (told '?frame '(robot-base-frame ?robot ?frame))
        *robot-torso-frame* (told '?link '(robot-torso-link-joint ?robot ?link ?joint))
        *robot-torso-joint* (told '?joint '(robot-torso-link-joint ?robot ?link ?joint))
        *robot-left-tool-frame* (told '?frame '(robot-tool-frame ?robot :left ?frame))
        *robot-right-tool-frame* (told '?frame '(robot-tool-frame ?robot :right ?frame))))

(defun simulated-time-p ()
  (roslisp:get-param "/use_sim_time" nil))

(defun init-tf ()
  "Name the frames, and listen to /tf."
  (set-frames)
  (setf *transformer* (make-instance 'cl-tf:transform-listener)
        *tf-default-timeout* (if (simulated-time-p) 10.0 4.0)))

(defun destroy-tf ()
  "Listen no more."
  (setf *transformer* nil))

(roslisp-utilities:register-ros-init-function init-tf)
(roslisp-utilities:register-ros-cleanup-function destroy-tf)

(defun transformer ()
  "The transformer; that there is none is an error."
  (or *transformer* (error "*transformer* is NIL. Have you called STARTUP-ROS?")))

(defun ensure-pose-in-frame (pose frame &key use-current-ros-time use-zero-time)
  "POSE as a stamped pose in FRAME; one without a frame is taken to be in it, and nil stays nil. USE-ZERO-TIME: where the frames were when
last heard of; USE-CURRENT-ROS-TIME: where they are now; else at the time of the pose."
  (cond ((null pose) nil)
        ((not (typep pose 'pose-stamped)) (pose->pose-stamped frame 0.0 pose))
        ((string= (frame-id pose) frame) pose)
        (t (transform-pose-stamped (transformer)
                                   :target-frame frame
                                   :pose (if use-zero-time (copy-pose-stamped pose :stamp 0.0) pose)
                                   :timeout *tf-default-timeout*
                                   :use-current-ros-time use-current-ros-time))))

(defun ensure-point-in-frame (point frame &key use-current-ros-time use-zero-time)
  "POINT as a stamped point in FRAME; see `ensure-pose-in-frame'."
  (cond ((null point) nil)
        ((not (typep point 'point-stamped)) (point->point-stamped frame 0.0 point))
        ((string= (frame-id point) frame) point)
        (t (transform-point-stamped (transformer)
                                    :target-frame frame
                                    :point (if use-zero-time (make-point-stamped (frame-id point) 0.0 (origin-of point)) point)
                                    :timeout *tf-default-timeout*
                                    :use-current-ros-time use-current-ros-time))))

(defun origin-of (point)
  (make-3d-vector (x point) (y point) (z point)))

(defun frame-to-pose-in-fixed-frame (frame-name)
  "Where a frame is in `*fixed-frame*': a stamped pose."
  (ensure-pose-in-frame (pose->pose-stamped frame-name 0.0 (make-identity-pose)) *fixed-frame* :use-zero-time t))

(defun robot-current-pose (&key (use-current-time-p t))
  "Where the robot stands, in `*fixed-frame*', on the floor. USE-CURRENT-TIME-P: now, and not when it was last heard of."
  (transformer)
  (let ((pose (ensure-pose-in-frame (pose->pose-stamped *robot-base-frame* 0.0 (make-identity-pose)) *fixed-frame*
                                    :use-current-ros-time use-current-time-p :use-zero-time (not use-current-time-p))))
    (copy-pose-stamped pose :origin (copy-3d-vector (origin pose) :z 0.0))))

(defun tf-frame-converged (goal-frame goal-pose-stamped delta-xy delta-theta)
  "Whether GOAL-FRAME is at a pose: as near to it along x and y as DELTA-XY, in metres, and turned as far from it as DELTA-THETA, in
radians, at most."
  (let* ((pose (ensure-pose-in-frame goal-pose-stamped goal-frame :use-zero-time t))
         (distance (max (abs (x (origin pose))) (abs (y (origin pose)))))
         (angle (abs (normalize-angle (get-yaw (orientation pose))))))
    (and (<= distance delta-xy) (<= angle delta-theta))))
