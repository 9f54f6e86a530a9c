;;;; Objects of a world: adding, finding, removing them; their poses and sizes; what touches.

(in-package #:cram-bullet-reasoning)

(defun ensure-vector (vector)
  "VECTOR, or the 3d-vector of a list of three numbers."
  (if (listp vector) (apply #'make-3d-vector vector) vector))

(defun ensure-pose (pose)
  "POSE, or the pose of a list ((x y z) (qx qy qz qw)), or (x y z)."
  (cond ((not (listp pose)) pose)
        ((listp (first pose)) (make-pose (ensure-vector (first pose)) (apply #'make-quaternion (second pose))))
        (t (make-pose (ensure-vector pose) (make-identity-rotation)))))

(defgeneric name (object)
  (:documentation "What OBJECT is called in its world.")
  (:method ((object object)) (robot-world:thing-name object)))

(defgeneric item-types (item)
  (:documentation "The types of ITEM, a list of keywords.")
  (:method ((item item)) (robot-world:thing-types item)))

(defgeneric object (world name)
  (:documentation "The object of that name in WORLD, or nil.")
  (:method (world name) (robot-world:find-thing world name)))

(defgeneric objects (world)
  (:documentation "All objects of WORLD, in the order in which they were added.")
  (:method (world) (robot-world:things world)))

(defun find-objects (world &optional (predicate (constantly t)))
  "The objects of WORLD that PREDICATE accepts."
  (remove-if-not predicate (objects world)))

(defgeneric remove-object (world name)
  (:documentation "Take the object of that name out of WORLD.")
  (:method (world name)
    (if (object world name)
        (robot-world:remove-thing world name)
        (warn "Could not find a body named `~a'" name))))

;;; Adding. Sizes of boxes and cylinders are whole lengths; those of the kinds of items are half of them, as in the original.

(defgeneric add-object (world type name pose &key &allow-other-keys)
  (:documentation "Add an object of a type to WORLD, and return it. POSE is a pose or a list.")
  (:method (world (type (eql :box)) name pose &key (mass 0.2) size color)
    (robot-world:add-shape world name :box (lengths size) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :colored-box)) name pose &key (mass 0.2) size (color '(0.5 0.5 0.5)))
    (robot-world:add-shape world name :box (lengths size) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :sphere)) name pose &key (mass 0.2) radius color)
    (robot-world:add-shape world name :sphere (list radius) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :cylinder)) name pose &key (mass 0.2) size color)
    (destructuring-bind (x y z) (lengths size)
      (robot-world:add-shape world name :cylinder (list (/ (+ x y) 4) z) (ensure-pose pose) :mass mass :color color)))
  (:method (world (type (eql :mesh)) name pose &key (mass 0.2) mesh color types)
    (robot-world:add-object-of-type world name mesh (ensure-pose pose) :mass mass :color color :types types))
  (:method (world (type (eql :urdf)) name pose &key urdf color)
    (robot-world:add-description world name (if (stringp urdf) (robot-world:read-description urdf) urdf) (ensure-pose pose) :color color))
  (:method (world type name pose &key (mass 0.2) color)
    (unless (member type (robot-world:object-types))
      (error "There is no object of type ~s. There are ~{~s~^, ~}, and :box, :sphere, :cylinder, :mesh and :urdf."
             type (robot-world:object-types)))
    (robot-world:add-object-of-type world name type (ensure-pose pose) :mass mass :color color)))

(defun lengths (size)
  "The three numbers of a list or a 3d-vector."
  (if (listp size) size (list (x size) (y size) (z size))))

;;; Sizes.

(defun calculate-bb-dims (object)
  "The lengths of the box around OBJECT when it is not turned, a 3d-vector."
  (let* ((alone (robot-world:copy-world (robot-world:thing-world object)))
         (copy (object alone (name object))))
    (setf (pose copy) (make-identity-pose))
    (bounding-box-dimensions (aabb copy))))

(defun item-dimensions (item-or-type)
  "The lengths of the box around an item, or around an object of a type, a 3d-vector."
  (if (typep item-or-type 'object)
      (calculate-bb-dims item-or-type)
      (or (robot-world:object-size item-or-type)
          (error "Couldn't fine a mesh for object type ~a." item-or-type))))

;;; What touches what.

(defun find-all-contacts (world)
  "A list of two objects for each pair that touches; each pair is there both ways."
  (remove-duplicates
   (loop for (one nil other) in (robot-world:contacts world)
         when other collect (list one other) and collect (list other one))
   :test #'equal :from-end t))

(defun find-objects-in-contact (world object)
  "The objects that touch OBJECT."
  (remove-duplicates (remove nil (mapcar #'third (robot-world:contacts world object))) :from-end t))

(defun contact-p (world object other)
  "Whether the two objects touch."
  (and (member other (find-objects-in-contact world object)) t))

(defun above-p (object other)
  "Whether the middle of OBJECT is as high as that of OTHER, or higher, wherever they are."
  (>= (z (bounding-box-center (aabb object))) (z (bounding-box-center (aabb other)))))

(defun stable-p (object)
  "Whether OBJECT would still be where it is after five seconds."
  (or (not (typep object 'item)) (robot-world:stable object)))
