;;;; The parts of a robot. The slots are those of the original, so that programs may change them: a slot that the file says nothing of is
;;;; unbound; its reader returns nil.

(in-package #:cl-urdf)

(defun no-transform ()
  (cl-transforms:make-transform (cl-transforms:make-3d-vector 0 0 0) (cl-transforms:make-quaternion 0 0 0 1)))

(defclass part () ()
  (:documentation "What a URDF file has an element for."))

(defmethod slot-unbound (class (part part) slot-name)
  "A file may leave it out."
  (declare (ignore class slot-name))
  nil)

(defclass named (part)
  ((name :initarg :name :reader name)))

(defmethod print-object ((object named) stream)
  (print-unreadable-object (object stream :type t)
    (princ (name object) stream)))

(defclass geometry (part) ()
  (:documentation "A shape."))

(defclass box (geometry)
  ((size :initarg :size :reader size :documentation "Its lengths, a 3d-vector.")))

(defclass cylinder (geometry)
  ((radius :initarg :radius :reader radius)
   (length :initarg :length :reader cylinder-length)))

(defclass sphere (geometry)
  ((radius :initarg :radius :reader radius)))

(defclass mesh (geometry)
  ((filename :initarg :filename :reader filename)
   (scale :initarg :scale :initform nil :reader scale :documentation "How many times as large along each axis, a 3d-vector.")
   (size :initarg :size :initform nil :reader size)))

(defclass material (named)
  ((color :initarg :color :initform '(0.8d0 0.8d0 0.8d0 1.0d0) :reader color :documentation "Red, green, blue and alpha, from 0 to 1.")
   (texture :initarg :texture :reader texture :documentation "A file."))
  (:documentation "What a surface looks like."))

(defclass placed (part)
  ((origin :initarg :origin :initform (no-transform) :reader origin :documentation "Where it is in the link, a transform.")))

(defclass inertial (placed)
  ((mass :initarg :mass :initform 0 :reader mass :documentation "In kilograms.")
   (inertia :initarg :inertia :reader inertia))
  (:documentation "What a link weighs."))

(defclass visual (placed)
  ((geometry :initarg :geometry :reader geometry)
   (material :initarg :material :initform (make-instance 'material) :reader material))
  (:documentation "What is seen of a link."))

(defclass collision (placed)
  ((geometry :initarg :geometry :reader geometry))
  (:documentation "What is touched of a link."))

(defclass link (named)
  ((from-joint :initarg :from-joint :initform nil :reader from-joint :documentation "The joint that leads to it; nil for the root.")
   (to-joints :initarg :joints :initform nil :reader to-joints :documentation "The joints that begin at it.")
   (inertial :initarg :inertial :reader inertial)
   (visual :initarg :visual :reader visual :documentation "The first of its visuals, or nil.")
   (visuals :initarg :visuals :reader visuals :documentation "All that is seen of it.")
   (collision :initarg :collision :reader collision :documentation "The first of its collisions, or nil.")
   (collisions :initarg :collisions :reader collisions :documentation "All that is touched of it.")
   (collisions-in-file :initarg :collisions-in-file :initform nil :reader collisions-in-file))
  (:documentation "A rigid part of a robot."))

(defclass mimics (part)
  ((joint :initarg :joint :reader joint :documentation "The name of the joint that is followed.")
   (multiplier :initarg :multiplier :initform 0 :reader multiplier)
   (offset :initarg :offset :initform 0 :reader offset))
  (:documentation "How a joint follows another."))

(defclass limits (part)
  ((upper :initarg :upper :initform 0 :reader upper)
   (lower :initarg :lower :initform 0 :reader lower)
   (effort :initarg :effort :reader effort)
   (velocity :initarg :velocity :reader velocity))
  (:documentation "What a joint can do."))

(defclass joint (named)
  ((type :initarg :type :reader joint-type :documentation ":FIXED, :REVOLUTE, :CONTINUOUS or :PRISMATIC.")
   (axis :initarg :axis :initform (cl-transforms:make-3d-vector 1 0 0) :reader axis :documentation "A 3d-vector in the frame of the child.")
   (origin :initarg :origin :initform (no-transform) :reader origin :documentation "Where the child is at 0, a transform.")
   (parent :initarg :parent :reader parent)
   (child :initarg :child :reader child)
   (limits :initarg :limits :reader limits)
   (mimics :initarg :mimics :reader mimics)
   (origin-in-file :initarg :origin-in-file :initform nil :reader origin-in-file))
  (:documentation "How one link moves against another."))

(defclass robot (named)
  ((links :initarg :links :reader links :documentation "A hash table of the links by their names.")
   (joints :initarg :joints :reader joints :documentation "A hash table of the joints by their names.")
   (root-link :initarg :root-link :reader root-link :documentation "The link that the robot begins with.")
   (materials :initarg :materials :reader materials :documentation "A hash table of the materials by their names.")
   (description :initarg :description :initform nil :reader description :documentation "What worlds take, or nil.")
   (text :initarg :text :initform nil :reader text :documentation "The text that it was read from, or nil."))
  (:documentation "A robot, or furniture: a tree of links. Its parts are made when they are first asked for."))
