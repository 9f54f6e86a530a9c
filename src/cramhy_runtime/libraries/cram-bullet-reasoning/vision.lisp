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

;;; The original draws in a window. Here the page shows the world, and what is drawn for debugging is nothing.

(defvar *debug-window* nil "The window, which there never is.")

(defun add-debug-window (world)
  "There is no window: the page shows the world."
  (declare (ignore world))
  nil)

(defgeneric add-vis-axis-object (object &optional length)
  (:documentation "Nothing: the page shows the frames of objects.")
  (:method (object &optional (length 0.30)) (declare (ignore object length)) nil))

(defun remove-vis-axis-object ()
  "Nothing is shown."
  nil)

(defun add-costmap-function-object (costmap)
  "Nothing: the page shows costmaps."
  (declare (ignore costmap))
  nil)

(defun add-costmap-sample-object (pose)
  "Nothing: the page shows samples of costmaps."
  (declare (ignore pose))
  nil)

(defun clear-costmap-vis-object ()
  "Nothing is shown."
  nil)
