(require cramhy *)
(in-package :kitchen)

(defparameter *bottle-on-counter* (pose 1.42d0 0.6d0 0.96d0) "a place on the counter, beside the sink")
(defparameter *bottle-on-island* (pose -0.8d0 2.0d0 0.96d0) "a place on the kitchen island")
(defparameter *before-counter* (pose 0.75d0 0.6d0 0) "where the robot stands to reach the counter")
(defparameter *before-island* (pose -0.15d0 2.0d0 0 180) "where it stands to reach the island")

(defun go-to (?place)
  "Drives to a pose, or to what a location designator stands for."
  (perform (an action (type going) (target (a location (pose ?place))))))

(defun look-at (?place)
  "Turns the head towards a pose."
  (perform (an action (type looking) (target (a location (pose ?place))))))

(defun detect (?type)
  "The designator of a thing of that type which the robot sees from where it is."
  (perform (an action (type detecting) (object (an object (type ?type))))))

(defun pick-up (?thing ?arm ?grasp)
  "Takes a thing that was detected with an arm, and brings the arm to where it can carry it."
  (perform (an action (type picking-up) (arm ?arm) (grasp ?grasp) (object ?thing)))
  (pp-plans:park-arms :arm ?arm))

(defun put-down (?thing ?place)
  "Puts down a thing that the robot holds."
  (perform (an action (type placing) (object ?thing) (target (a location (pose ?place)))))
  (pp-plans:park-arms))

(defun get-ready ()
  "Raises the torso and brings the arms out of the way."
  (par
    (perform (a motion (type moving-torso) (joint-angle 0.3)))
    (pp-plans:park-arms)))

(defun move-bottle ()
  "Carries a bottle from the counter to the island: go, look, detect, pick up, carry, place."
  (with-simulated-robot
    (get-ready)
    (go-to *before-counter*)
    (look-at *bottle-on-counter*)
    (let ((bottle (detect :bottle)))
      (pick-up bottle :right :back)
      (go-to *before-island*)
      (put-down bottle *bottle-on-island*))))
