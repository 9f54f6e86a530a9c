;;;; The robot of the current world.

(in-package #:cram-bullet-reasoning-utilities)

(defun robot-name ()
  "The name of the robot."
  (get-robot-name))

(defun move-robot (&optional (pose '((0 0 0) (0 0 0 1))))
  "Put the robot somewhere."
  (setf (pose (get-robot-object)) (ensure-pose pose)))

(defun move-robot-away ()
  "Put the robot where it is in nobody's way."
  (move-robot '((100 100 0) (0 0 0 1))))

(defun park-robot ()
  "Let the robot stand at the origin with its arms parked and the torso half up."
  (let ((robot (get-robot-object)))
    (move-robot)
    (dolist (solution (force-ll (prolog '(and (robot ?robot) (robot-arms-parking-joint-states ?robot ?states ?arm)))))
      (set-robot-state-from-joints (var-value '?states solution) robot))
    (dolist (solution (force-ll (prolog '(and (robot ?robot) (robot-torso-link-joint ?robot ?link ?joint)))))
      (set-robot-state-from-joints `((,(var-value '?joint solution) 0.16825)) robot))))
