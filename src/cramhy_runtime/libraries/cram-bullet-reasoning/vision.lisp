;;;; Seeing: how much of an object a camera sees, and what stands before it.

(in-package #:cram-bullet-reasoning)

(defvar *visibility-threshold* 0.9
  "Which part of an object's picture must be seen, for the object to count as visible.")

(defstruct object-visibility
  "PERCENTAGE: which part of an object's picture is seen, 0 to 1. OCCLUDING-OBJECTS: those that hide the rest, those that hide most first."
  percentage occluding-objects)

(defun calculate-object-visibility (world camera-pose object &optional width height)
  "What is seen of OBJECT from CAMERA-POSE, an OBJECT-VISIBILITY. The size of the picture does not matter here."
  (declare (ignore width height))
  (multiple-value-bind (part hiding) (robot-world:visibility world camera-pose object)
    (make-object-visibility :percentage part :occluding-objects hiding)))

(defun object-visible-p (world camera-pose object &optional (threshold *visibility-threshold*))
  "Whether enough of OBJECT is seen from CAMERA-POSE, which looks along its z axis."
  (>= (object-visibility-percentage (calculate-object-visibility world camera-pose object)) threshold))

(defun occluding-objects (world camera-pose object)
  "The objects that hide a part of OBJECT, those that hide most first."
  (object-visibility-occluding-objects (calculate-object-visibility world camera-pose object)))

(defclass camera ()
  ((width :initarg :width :initform 320 :reader width)
   (height :initarg :height :initform 200 :reader height)
   (fov-y :initarg :fov-y :initform 50 :reader fov-y :documentation "The angle of view in degrees, from the lower to the upper border.")
   (z-near :initarg :z-near :initform 0.1 :reader z-near)
   (z-far :initarg :z-far :initform 10.0 :reader z-far)
   (pose :initarg :pose :initform (make-identity-pose) :reader pose))
  (:documentation "A camera that looks along its z axis."))

(defmethod initialize-instance :after ((camera camera) &key transform)
  (when transform
    (setf (slot-value camera 'pose) (make-pose (translation transform) (rotation transform)))))

(defmethod camera-transform ((camera camera))
  "From the origin to CAMERA."
  (make-transform (origin (pose camera)) (orientation (pose camera))))

(defun look-at-object-rotation (camera-pose object-pose)
  "The rotation of a camera at CAMERA-POSE whose z axis points to OBJECT-POSE."
  (let* ((z-axis (make-3d-vector 0 0 1))
         (direction (v- (origin object-pose) (origin camera-pose)))
         (angle (acos (/ (dot-product direction z-axis) (v-norm direction)))))
    (q* (axis-angle->quaternion (cross-product z-axis direction) angle)
        (axis-angle->quaternion z-axis (/ pi 2)))))

;;; What the original does with OpenGL, or knows of semantic maps, is not here. The names are, so that programs can be read.

(macrolet ((absent (what &rest names)
             `(progn ,@(loop for name in names
                             collect `(defun ,name (&rest arguments)
                                        (declare (ignore arguments))
                                        (error "~a ~a" ',name ,what))))))
  (absent "draws with OpenGL, which cramhy does not. BTR:SAVE-PICTURE makes pictures of worlds, BTR:CALCULATE-OBJECT-VISIBILITY tells what is seen."
          gl-execute-with-camera render-to-framebuffer get-rendering-context read-pixelbuffer read-depthbuffer to-png-image
          make-drawable-list drawable-list-drawables)
  (absent "asks the database of household objects, which cramhy does not have. BTR:ADD-OBJECTS-TO-MESH-LIST makes the meshes of a package known."
          init-ros-object-database)
  (absent "asks a semantic map of KnowRob, which cramhy does not have. BTR:LINK-POSE tells where a link of the furniture is."
          semantic-map-part-pose))

(defmacro with-rendering-to-framebuffer ((width height) &body body)
  (declare (ignore width height body))
  '(get-rendering-context))

;;; The original draws in a window. Here the page shows the world, and what is drawn for debugging is nothing.

(defvar *debug-window* nil "The window, which there never is.")

(defun add-debug-window (world)
  "There is no window: the page shows the world."
  (declare (ignore world))
  nil)

(defgeneric add-vis-axis-object (object &rest options)
  (:documentation "Nothing: the page shows the frames of objects. OPTIONS: a length, or :LENGTH, :WIDTH and :ID.")
  (:method (object &rest options) (declare (ignore object options)) nil))

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

(defun clear-costmap-vis-object (&key (costmap t) (sample t) (axes t))
  "Nothing is shown."
  (declare (ignore costmap sample axes))
  nil)
