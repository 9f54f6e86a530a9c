;;;; cl-bullet: what plans use of the physics engine's binding. Here the engine is MuJoCo, below ROBOT-WORLD.

(defpackage #:cl-bullet
  (:use #:common-lisp #:cffi #:cffi-ros-utils)
  (:nicknames #:bullet)
  (:export #:bounding-box #:make-bounding-box #:bounding-box-center #:bounding-box-dimensions #:aabb #:pose #:points
           #:bt-world #:copy-world #:step-simulation
           #:rigid-body #:name #:mass #:collision-shape #:collision-flags #:linear-velocity #:angular-velocity #:clear-forces))

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

;;; Bodies. CRAM-BULLET-REASONING says which there are: items, and links of robots. A body is its own shape.

(defgeneric name (thing)
  (:documentation "What THING is called."))

(defgeneric mass (body)
  (:documentation "The kilograms of a body; 0 of one that does not fall."))

(defgeneric collision-flags (body)
  (:documentation "What Bullet is told of BODY: the list (:CF-STATIC-OBJECT) of one that does not fall, else ()."))

(defgeneric (setf collision-flags) (new-value body)
  (:documentation "With :CF-STATIC-OBJECT in NEW-VALUE, a keyword or a list, keep BODY from falling; without, let it fall."))

(defun collision-shape (body)
  "The shape of BODY, for CL-BULLET-VIS:COLLISION-SHAPE-COLOR."
  body)

;;; What falls comes to rest before anybody looks, so no body moves and no force acts on it.

(defun linear-velocity (body)
  "The velocity of BODY, a 3d-vector in metres a second: 0, since what falls comes to rest before anybody looks."
  (declare (ignore body))
  (cl-transforms:make-identity-vector))

(defun angular-velocity (body)
  "How fast BODY turns, a 3d-vector in radians a second: 0, as `linear-velocity'."
  (declare (ignore body))
  (cl-transforms:make-identity-vector))

(defun rest-only (velocity)
  (if (zerop (cl-transforms:v-norm velocity))
      velocity
      (error "A body of cramhy's world rests until the world is simulated: its velocity can be set to 0 only.")))

(defun (setf linear-velocity) (new-value body)
  (declare (ignore body))
  (rest-only new-value))

(defun (setf angular-velocity) (new-value body)
  (declare (ignore body))
  (rest-only new-value))

(defun clear-forces (body)
  "Nothing: no force acts on BODY for longer than a simulation."
  (declare (ignore body))
  nil)
