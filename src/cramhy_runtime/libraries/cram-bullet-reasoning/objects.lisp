;;;; Objects of a world: adding, finding, removing them; their poses and sizes; what touches.

(in-package #:cram-bullet-reasoning)

(defun ensure-vector (vector)
  "VECTOR, or the 3d-vector of a list of three numbers."
  (if (listp vector) (apply #'make-3d-vector vector) vector))

(defun ensure-pose (pose)
  "POSE, or the pose of a list ((x y z) (qx qy qz qw)), or (x y z). A pose in another frame than the world's is transformed."
  (cond ((typep pose 'pose-stamped) (in-the-world pose))
        ((not (listp pose)) pose)
        ((listp (first pose)) (make-pose (ensure-vector (first pose)) (apply #'make-quaternion (second pose))))
        (t (make-pose (ensure-vector pose) (make-identity-rotation)))))

(defun in-the-world (pose)
  "POSE, which is stamped, in the frame of the world."
  (let ((frame (or *fixed-frame* "map")))
    (if (string= (string-left-trim "/" (frame-id pose)) (string-left-trim "/" frame))
        pose
        (ensure-pose-in-frame pose frame :use-zero-time t))))

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
  (:documentation "Add an object of a type to WORLD, and return it. POSE is a pose or a list. The keys depend on the type; with all of them
:DISABLE-COLLISIONS-WITH names objects whose contacts with this one do not count.")
  (:method :around (world type name pose &key disable-collisions-with &allow-other-keys)
    (let ((object (call-next-method)))
      (dolist (other disable-collisions-with object)
        (robot-world:ignore-contact world name other))))
  (:method (world (type (eql :box)) name pose &key (mass 0.2) size color)
    (robot-world:add-shape world name :box (lengths size) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :colored-box)) name pose &key (mass 0.2) size (color '(0.5 0.5 0.5)))
    (robot-world:add-shape world name :box (lengths size) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :visualization-box)) name pose &key size (color '(0.5 0.5 0.5 0.4)))
    (robot-world:add-shape world name :box (lengths size) (ensure-pose pose) :mass 0 :color color :drawn t))
  (:method (world (type (eql :sphere)) name pose &key (mass 0.2) radius color)
    (robot-world:add-shape world name :sphere (list radius) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :cylinder)) name pose &key (mass 0.2) size color)
    (destructuring-bind (x y z) (lengths size)
      (robot-world:add-shape world name :cylinder (list (/ (+ x y) 4) z) (ensure-pose pose) :mass mass :color color)))
  (:method (world (type (eql :cone)) name pose &key (mass 0.2) radius height color)
    (robot-world:add-shape world name :cone (list radius height) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :point-cloud)) name pose &key points (mass 0) color)
    (robot-world:add-shape world name :points (coerce points 'list) (ensure-pose pose) :mass mass :color color))
  (:method (world (type (eql :static-plane)) name pose &key (normal '(0 0 1)) (constant 0) color)
    (robot-world:add-shape world name :plane () (plane-pose (ensure-pose pose) (ensure-vector normal) constant) :mass 0 :color color))
  (:method (world (type (eql :mesh)) name pose &key (mass 0.2) mesh color types (scale 1.0) disable-face-culling)
    (declare (ignore disable-face-culling))
    (add-mesh-item world name (ensure-pose pose) mesh :mass mass :color color :types types :scale scale))
  (:method (world (type (eql :cutlery)) name pose &key (mass 0.2) (cutlery-type :knife) color)
    (robot-world:add-object-of-type world name cutlery-type (ensure-pose pose) :mass mass :color color :types (list type cutlery-type)))
  (:method (world (type (eql :generic-cup)) name pose &key (mass 0.2) (radius 0.04) (height 0.09) color)
    (robot-world:add-shape world name :cylinder (list radius height) (ensure-pose pose) :mass mass :color color :types '(:generic-cup)))
  (:method (world (type (eql :urdf)) name pose &key urdf color (collision-group :character-filter) collision-mask compound)
    (declare (ignore collision-mask compound))
    (robot-world:add-description world name (description-in-world urdf) (ensure-pose pose)
                                 :color color :fixed (eq collision-group :static-filter)))
  (:method (world type name pose &key (mass 0.2) size radius color)
    (cond (size
           (add-half-lengths world name type size (ensure-pose pose) mass color))
          (radius
           (robot-world:add-shape world name :sphere (list radius) (ensure-pose pose) :mass mass :color color :types (list type)))
          ((or (member type (robot-world:object-types)) (file-of-mesh type))
           (add-mesh-item world name (ensure-pose pose) type :mass mass :color color))
          (t
           (error "There is no object of type ~s. There are ~{~s~^, ~}, and :box, :sphere, :cylinder, :cone, :static-plane, :mesh and :urdf."
                  type (robot-world:object-types))))))

(defun description-in-world (urdf)
  "What a world takes of URDF: a text, a robot of CL-URDF with what a program has changed of it, or a description of ROBOT-WORLD."
  (cl-urdf::description-of (if (stringp urdf) (cl-urdf:parse-urdf urdf) urdf)))

(defun add-half-lengths (world name type size pose mass color)
  "Add an item of a kind whose size is given as half its lengths: a cylinder where things of the kind are round, else a box."
  (destructuring-bind (x y z) (lengths size)
    (unless (member type '(:pancake-maker :pancake :orange :apple :sugar-box :cereal :mug :generic-cup))
      (error "An object of type ~s has no :size." type))
    (if (member type '(:pancake-maker :pancake :mug :generic-cup))
        (robot-world:add-shape world name :cylinder (list (/ (+ x y) 2) (* 2 z)) pose :mass mass :color color :types (list type))
        (robot-world:add-shape world name :box (list (* 2 x) (* 2 y) (* 2 z)) pose :mass mass :color color :types (list type)))))

(defun plane-pose (pose normal constant)
  "The pose of a plane whose points have the distance CONSTANT from POSE, along NORMAL, which is given in the frame of POSE."
  (let* ((normal (v* normal (/ (v-norm normal))))
         (up (make-3d-vector 0 0 1))
         (axis (cross-product up normal))
         (turn (cond ((> (v-norm axis) 1d-9) (axis-angle->quaternion axis (acos (max -1 (min 1 (dot-product up normal))))))
                     ((plusp (z normal)) (make-identity-rotation))
                     (t (make-quaternion 1 0 0 0))))
         (plane (transform-pose (pose->transform pose) (make-pose (v* normal constant) turn))))
    plane))

(defun lengths (size)
  "The three numbers of a list or a 3d-vector."
  (if (listp size) size (list (x size) (y size) (z size))))

;;; Sizes.

(defun calculate-bb-dims (object &key initial-pose)
  "The lengths of the box around OBJECT, an object or a body, when it is not turned, a 3d-vector. With CRAM-TF of the branch devel, and
unless INITIAL-POSE is true, it lies on the side on which it lies now."
  (let ((aligned (find-symbol "MAP-AXIS-ALIGNED-ORIENTATION" '#:cram-tf)))
    (turned-lengths object (if (and aligned (fboundp aligned) (not initial-pose))
                               (funcall aligned (orientation (pose object)))
                               (make-identity-rotation)))))

(defgeneric turned-lengths (object rotation)
  (:documentation "The lengths of the box around OBJECT, an object or a body, if it had that ROTATION.")
  (:method ((object object) rotation) (robot-world:thing-lengths object rotation)))

(defun item-dimensions (item-or-type)
  "The lengths of the box around an item, or around an object of a type, a 3d-vector."
  (if (typep item-or-type 'object)
      (calculate-bb-dims item-or-type)
      (or (mesh-dimensions item-or-type)
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

(defun below-p (object other)
  "Whether the middle of OBJECT is as low as that of OTHER, or lower, wherever they are."
  (above-p other object))

(defun find-objects-above (world object)
  "The objects that are above OBJECT."
  (find-objects world (lambda (other) (and (not (eq other object)) (above-p other object)))))

(defun find-objects-below (world object)
  "The objects that are below OBJECT."
  (find-objects world (lambda (other) (and (not (eq other object)) (below-p other object)))))

(defun stable-p (object)
  "Whether OBJECT would still be where it is after five seconds."
  (or (not (typep object 'item)) (robot-world:stable object)))

(defun disabled-collision-objects (world)
  "The pairs of names (name . other) of objects whose contacts do not count."
  (robot-world:ignored-contacts world))

;;; The bodies of an object: of an item one, of a robot one for each link that has shapes.

(defclass rigid-body ()
  ((name :initarg :name :reader name)
   (object :initarg :object :reader body-object)
   (link :initarg :link :initform nil :reader body-link))
  (:documentation "An item, or a link of a robot."))

(defmethod mass ((body rigid-body))
  (if (body-link body) 0 (robot-world:thing-mass (body-object body))))

(defmethod collision-flags ((body rigid-body))
  (if (or (body-link body) (robot-world:thing-stays (body-object body))) (list :cf-static-object) '()))

(defmethod (setf collision-flags) (new-value (body rigid-body))
  (when (body-link body)
    (error "The link ~a moves with its robot: its collision flags cannot be set." (name body)))
  (robot-world:set-thing-stays (body-object body) (member :cf-static-object (if (listp new-value) new-value (list new-value))))
  new-value)

(defmethod collision-shape-color ((body rigid-body))
  (robot-world:thing-color (body-object body)))

(defmethod pose ((body rigid-body))
  (if (body-link body)
      (link-pose (body-object body) (body-link body))
      (pose (body-object body))))

(defmethod (setf pose) (new-value (body rigid-body))
  (if (body-link body)
      (setf (link-pose (body-object body) (body-link body)) new-value)
      (setf (pose (body-object body)) new-value)))

(defmethod turned-lengths ((body rigid-body) rotation)
  (robot-world:thing-lengths (body-object body) rotation (body-link body)))

(defmethod aabb ((body rigid-body))
  (if (body-link body)
      (cl-bullet::bounding-box-of (robot-world:part-bounds (body-object body) (body-link body)))
      (aabb (body-object body))))

(defun make-rigid-body-name (object-name link-name)
  "The name of the body of a link: a keyword, such as :|KITCHEN.sink_area|."
  (intern (format nil "~a.~a" object-name link-name) :keyword))

(defun solid-links (robot)
  "The names of the links of ROBOT that have shapes."
  (loop for (name nil shapes) in (robot-world:description-links (robot-world:machine-description robot))
        when shapes collect name))

(defgeneric rigid-bodies (object)
  (:documentation "The list of the bodies of OBJECT.")
  (:method ((item item)) (list (make-instance 'rigid-body :name (name item) :object item)))
  (:method ((robot robot-object))
    (loop for link in (solid-links robot)
          collect (make-instance 'rigid-body :name (make-rigid-body-name (name robot) link) :object robot :link link))))

(defgeneric world (object)
  (:documentation "The world that OBJECT is in.")
  (:method ((object object)) (robot-world:thing-world object)))

(defun make-object (world name &optional rigid-bodies (add t))
  "The original makes an object of bodies of Bullet's, which are not here."
  (declare (ignore world rigid-bodies add))
  (error "~a cannot be made of bodies of Bullet's, which cramhy does not have. Use (btr:add-object world type ~s pose ...)." name name))

(defun merge-bounding-boxes (box other)
  "The bounding box around two bounding boxes."
  (flet ((corner (box operation)
           (funcall operation (bounding-box-center box) (v* (bounding-box-dimensions box) 0.5)))
         (extreme (function one two)
           (make-3d-vector (funcall function (x one) (x two)) (funcall function (y one) (y two)) (funcall function (z one) (z two)))))
    (let ((low (extreme #'min (corner box #'v-) (corner other #'v-)))
          (high (extreme #'max (corner box #'v+) (corner other #'v+))))
      (cl-bullet:make-bounding-box :center (v* (v+ low high) 0.5) :dimensions (v- high low)))))

(defun rigid-body-names (object)
  "The names of the bodies of OBJECT."
  (mapcar #'name (rigid-bodies object)))

(defun rigid-body (object name)
  "The body of OBJECT that has that name, or nil."
  (find name (rigid-bodies object) :key #'name))

(defun copy-object (object world)
  "A copy of OBJECT, with what it holds, is in each copy of its world: that in WORLD, or nil."
  (object world (name object)))

(defun invalidate-object (object)
  "Where an object's parts are is computed when it is asked for, so nothing is to be forgotten."
  object)
