;;;; Seeing: how much of an object a camera sees, and what stands before it.

(in-package #:cram-bullet-reasoning)

(defvar *visibility-threshold* 0.9
  "Which part of an object's picture must be seen, for the object to count as visible.")

(defun calculate-object-visibility (world camera-pose object)
  "Two values: which part of OBJECT's picture is seen from CAMERA-POSE, 0 to 1, and the objects that hide the rest."
  (robot-world:visibility world camera-pose object))

(defun object-visible-p (world camera-pose object &optional (threshold *visibility-threshold*))
  "Whether enough of OBJECT is seen from CAMERA-POSE, which looks along its z axis."
  (>= (calculate-object-visibility world camera-pose object) threshold))

(defun occluding-objects (world camera-pose object)
  "The objects that hide a part of OBJECT, those that hide most first."
  (nth-value 1 (calculate-object-visibility world camera-pose object)))
