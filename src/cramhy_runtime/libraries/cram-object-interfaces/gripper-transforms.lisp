;;;; Where a gripper is when it takes hold of an object, just before and after: transforms from the object to the standard gripper, whose z
;;;; axis points at the object. Knowledge about objects is methods for types of objects, arms and grasps.

(in-package #:cram-object-interfaces)

(defgeneric get-object-type-gripping-effort (object-type)
  (:documentation "How firmly to hold an object of this type, in newtons."))

(defgeneric get-object-type-gripper-opening (object-type)
  (:documentation "How far to open the gripper for an object of this type, in metres."))

(defgeneric get-object-type-to-gripper-transform (object-type object-name arm grasp)
  (:documentation "From the object to the gripper that holds it."))

(defgeneric get-object-type-to-gripper-pregrasp-transform (object-type object-name arm grasp grasp-transform)
  (:documentation "From the object to the gripper at the beginning of the way to it; GRASP-TRANSFORM is the one at its end."))

(defgeneric get-object-type-to-gripper-2nd-pregrasp-transform (object-type object-name arm grasp grasp-transform)
  (:documentation "From the object to the gripper shortly before it is reached."))

(defgeneric get-object-type-to-gripper-lift-transform (object-type object-name arm grasp grasp-transform)
  (:documentation "From where the object was to the gripper that has lifted it."))

(defgeneric get-object-type-to-gripper-2nd-lift-transform (object-type object-name arm grasp grasp-transform)
  (:documentation "From where the object was to the gripper that has lifted it still further."))

(defvar *back-grasp-rotation* '((0 0 1) (1 0 0) (0 1 0)))
(defvar *front-grasp-rotation* '((0 0 -1) (-1 0 0) (0 1 0)))
(defvar *left-side-grasp-rotation* '((1 0 0) (0 0 -1) (0 1 0)))
(defvar *right-side-grasp-rotation* '((-1 0 0) (0 0 1) (0 1 0)))
(defvar *top-across-x-grasp-rotation* '((0 1 0) (1 0 0) (0 0 -1)))
(defvar *top-across-y-grasp-rotation* '((1 0 0) (0 -1 0) (0 0 -1)))

(defun object-frame (object-name)
  "The name of an object's frame: BOTTLE-1 has \"bottle_1\"."
  (roslisp-utilities:rosify-underscores-lisp-name object-name))

(defun fact (variable goal)
  "The value of VARIABLE in the first solution of GOAL, or nil."
  (let ((solution (cut:lazy-car (prolog goal))))
    (when solution
      (let ((value (cut:var-value variable solution)))
        (unless (cut:is-var value) value)))))

(defun tool-frame (arm)
  "The name of the frame of an arm's tool, which is where its gripper takes hold of things."
  (or (ecase arm
        (:left cram-tf:*robot-left-tool-frame*)
        (:right cram-tf:*robot-right-tool-frame*))
      (fact '?frame `(and (cram-robot-interfaces:robot ?robot) (cram-robot-interfaces:robot-tool-frame ?robot ,arm ?frame)))
      (format nil "~(~A~)_tool_frame" arm)))

(defun gripper-transform (object-name arm translation rotation-matrix)
  "The transform from an object to the gripper of ARM, of a list and a list of rows."
  (cl-transforms-stamped:make-transform-stamped
   (object-frame object-name) (tool-frame arm) 0.0
   (apply #'cl-transforms:make-3d-vector translation)
   (cl-transforms:matrix->quaternion (make-array '(3 3) :initial-contents rotation-matrix))))

(defun offset (transform offsets)
  "TRANSFORM, moved by a list of three lengths along the axes of the object."
  (destructuring-bind (x y z) offsets
    (cram-tf:translate-transform-stamped transform :x-offset x :y-offset y :z-offset z)))

(defun undefined (what object-type arm grasp)
  (error "~A transform not defined for object type ~a with arm ~a and grasp ~a~%" what object-type arm grasp))

(defun define-gripper-transforms (object-type arm grasp-type translation rotation-matrix pregrasp 2nd-pregrasp lift 2nd-lift)
  "Define the five methods for one type of objects, arm and grasp; see `def-object-type-to-gripper-transforms'."
  (defmethod get-object-type-to-gripper-transform
      ((object-type (eql object-type)) object-name (arm (eql arm)) (grasp (eql grasp-type)))
    (if (and translation rotation-matrix)
        (gripper-transform object-name arm translation rotation-matrix)
        (undefined "Grasp" object-type arm grasp)))
  (macrolet ((define-offset (name what offsets)
               `(defmethod ,name ((object-type (eql object-type)) object-name (arm (eql arm)) (grasp (eql grasp-type)) grasp-transform)
                  (declare (ignore object-name))
                  (if ,offsets
                      (offset grasp-transform ,offsets)
                      (undefined ,what object-type arm grasp)))))
    (define-offset get-object-type-to-gripper-pregrasp-transform "Pregrasp" pregrasp)
    (define-offset get-object-type-to-gripper-2nd-pregrasp-transform "2nd pregrasp" 2nd-pregrasp)
    (define-offset get-object-type-to-gripper-lift-transform "Lift" lift)
    (define-offset get-object-type-to-gripper-2nd-lift-transform "2nd lift" 2nd-lift)))

(defmacro def-object-type-to-gripper-transforms (object-type arm grasp-type
                                                 &key grasp-translation grasp-rot-matrix pregrasp-offsets 2nd-pregrasp-offsets
                                                   lift-offsets 2nd-lift-offsets)
  "Say where the gripper of ARM is when it takes hold of objects of OBJECT-TYPE by GRASP-TYPE. OBJECT-TYPE and ARM may be lists.
GRASP-TRANSLATION, three metres, and GRASP-ROT-MATRIX, a list of three rows: the gripper in the frame of the object. The other lists of
three metres are added to the translation: before the grasp and shortly before it, after it and well after it. All arguments are evaluated."
  `(dolist (object-type (listed ,object-type))
     (dolist (arm (listed ,arm))
       (define-gripper-transforms object-type arm ,grasp-type ,grasp-translation ,grasp-rot-matrix ,pregrasp-offsets
                                  ,2nd-pregrasp-offsets ,lift-offsets ,2nd-lift-offsets))))

(defun listed (thing)
  (if (listp thing) thing (list thing)))
