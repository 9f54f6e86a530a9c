;;;; cl-bullet: what plans use of the physics engine's binding. Here the engine is MuJoCo, below ROBOT-WORLD.

(defpackage #:cl-bullet
  (:use #:common-lisp #:cffi #:cffi-ros-utils)
  (:nicknames #:bullet)
  (:export #:bounding-box #:make-bounding-box #:bounding-box-center #:bounding-box-dimensions #:aabb #:pose #:points
           #:bt-world #:copy-world #:step-simulation))

(in-package #:cl-bullet)

(defstruct bounding-box
  "A box along the axes of the world: CENTER and DIMENSIONS are 3d-vectors, in metres."
  center dimensions)

(defun bounding-box-of (center-and-dimensions)
  "The bounding box of a list of its middle and its lengths."
  (destructuring-bind (center dimensions) center-and-dimensions
    (make-bounding-box :center center :dimensions dimensions)))

(eval-when (:compile-toplevel :load-toplevel :execute)
  (setf (find-class 'bt-world) (find-class 'robot-world:world)))

(defgeneric aabb (object)
  (:documentation "The bounding box of OBJECT, along the axes of the world.")
  (:method ((thing robot-world:thing)) (bounding-box-of (robot-world:thing-bounds thing))))

(defgeneric pose (object)
  (:documentation "Where OBJECT is in the world.")
  (:method ((thing robot-world:thing)) (robot-world:thing-pose thing)))

(defgeneric (setf pose) (new-value object)
  (:documentation "Put OBJECT somewhere else, and with it what it holds.")
  (:method (new-value (thing robot-world:thing)) (robot-world:set-thing-pose thing new-value)))

(defun copy-world (world &optional destination)
  "A copy of WORLD, with all that is in it, which goes its own way. DESTINATION: a world that becomes the copy."
  (robot-world:copy-world world destination))

(defun step-simulation (world seconds)
  "Let what is free in WORLD fall for SECONDS."
  (robot-world:settle world seconds)
  nil)
