;;;; Models of points and faces, their sizes and masses, and messages of them. A model is a mesh of ROBOT-WORLD.

(in-package #:cram-physics-utils)

(defstruct face
  "POINTS and NORMALS: lists of 3d-vectors, one for each corner."
  points normals)

(defun vector-of (numbers)
  (apply #'cl-transforms:make-3d-vector numbers))

(defun numbers-of (vector)
  (list (cl-transforms:x vector) (cl-transforms:y vector) (cl-transforms:z vector)))

(defun normal-of (points)
  "The vector of length 1 that a face with these corners, counterclockwise from outside, turns to."
  (destructuring-bind (one two three &rest more) points
    (declare (ignore more))
    (let* ((normal (cl-transforms:cross-product (cl-transforms:v- two one) (cl-transforms:v- three one)))
           (length (cl-transforms:v-norm normal)))
      (if (zerop length) normal (cl-transforms:v* normal (/ length))))))

(defun make-3d-model (&key vertices faces)
  "A model of VERTICES, a sequence of 3d-vectors, and FACES, a sequence of `face's with three or more corners."
  (let* ((corners (loop for face in (coerce faces 'list)
                        append (loop with (first . others) = (face-points face)
                                     for (second third) on others
                                     while third append (list first second third))))
         (points (append (coerce vertices 'list) corners))
         (start (length vertices)))
    (robot-world:make-mesh (mapcar #'numbers-of points)
                           (loop for index from start below (length points) by 3
                                 collect (list index (+ index 1) (+ index 2))))))

(defun 3d-model-vertices (model)
  "A vector of the points of MODEL, 3d-vectors."
  (map 'vector #'vector-of (robot-world:mesh-points model)))

(defun 3d-model-faces (model)
  "A vector of the triangles of MODEL, `face's."
  (map 'vector
       (lambda (corners)
         (let* ((points (mapcar #'vector-of corners)) (normal (normal-of points)))
           (make-face :points points :normals (list normal normal normal))))
       (robot-world:mesh-corners model)))

(defun fix-normals (faces &key always-recalculate)
  "FACES with normals where they have none, or with new ones for all if ALWAYS-RECALCULATE."
  (map 'vector
       (lambda (face)
         (if (and (face-normals face) (not always-recalculate))
             face
             (let ((normal (normal-of (face-points face))))
               (make-face :points (face-points face) :normals (mapcar (constantly normal) (face-points face))))))
       faces))

(defun calculate-aabb (points)
  "Two 3d-vectors: the lengths of the box around POINTS, a sequence of 3d-vectors, and its middle."
  (flet ((extreme (function)
           (vector-of (loop for axis in (list #'cl-transforms:x #'cl-transforms:y #'cl-transforms:z)
                            collect (reduce function points :key axis)))))
    (let ((low (extreme #'min)) (high (extreme #'max)))
      (values (cl-transforms:v- high low) (cl-transforms:v* (cl-transforms:v+ low high) 0.5)))))

(defun changed-model (model point-function)
  "A model like MODEL whose points are what POINT-FUNCTION makes of them."
  (make-3d-model :vertices (map 'vector point-function (3d-model-vertices model))
                 :faces (map 'vector (lambda (face) (make-face :points (mapcar point-function (face-points face))))
                             (3d-model-faces model))))

(defun scale-3d-model (model scale)
  "A model SCALE times as large: a number, or a 3d-vector with one for each axis."
  (let ((scales (if (numberp scale) (list scale scale scale) (numbers-of scale))))
    (if (every (lambda (number) (= number 1)) scales)
        model
        (changed-model model (lambda (point) (vector-of (mapcar #'* (numbers-of point) scales)))))))

(defun resize-3d-model (model size)
  "A model that fills the box whose lengths are SIZE, a 3d-vector."
  (scale-3d-model model (vector-of (mapcar #'/ (numbers-of size) (numbers-of (calculate-aabb (3d-model-vertices model)))))))

(defun transform-3d-model (model transform)
  "A model that is turned and moved by TRANSFORM."
  (changed-model model (lambda (point) (cl-transforms:transform-point transform point))))

(defgeneric calculate-mass (shape &key density &allow-other-keys)
  (:documentation "The mass in kilograms of a body: its volume in cubic metres times DENSITY. A mesh counts as the box around its points.")
  (:method ((shape (eql :sphere)) &key (density 1000) radius)
    (* density 4/3 pi radius radius radius))
  (:method ((shape (eql :box)) &key (density 1000) size-x size-y size-z)
    (* density size-x size-y size-z))
  (:method ((shape (eql :cylinder)) &key (density 1000) radius height)
    (* density pi radius radius height))
  (:method ((shape (eql :mesh)) &key (density 1000) points)
    (apply #'* density (numbers-of (calculate-aabb points)))))

;;; Messages.

(defun point-of-message (message)
  (roslisp:with-fields (x y z) message
    (cl-transforms:make-3d-vector x y z)))

(defun message-of-point (point type)
  (roslisp:make-message type :x (cl-transforms:x point) :y (cl-transforms:y point) :z (cl-transforms:z point)))

(defun check-type-of-shape (shape numbers disabled)
  (unless disabled
    (roslisp:with-fields (type) shape
      (unless (member type numbers)
        (error "The message is of a shape of type ~a; needed is ~{~a~^ or ~}." type numbers)))))

(defun shape-msg->points (shape &key disable-type-check)
  "A vector of the points of a message of a shape, 3d-vectors."
  (check-type-of-shape shape '(3 4) disable-type-check)
  (roslisp:with-fields (vertices) shape
    (map 'vector #'point-of-message vertices)))

(defun shape-msg->mesh (shape &key disable-type-check)
  "The model of a message of a mesh, whose triangles are numbers of points, three after three."
  (check-type-of-shape shape '(3) disable-type-check)
  (roslisp:with-fields (triangles vertices) shape
    (let ((points (map 'vector #'point-of-message vertices)))
      (make-3d-model :vertices points
                     :faces (loop for index from 0 below (length triangles) by 3
                                  collect (make-face :points (loop for corner in '(0 2 1)
                                                                   collect (aref points (elt triangles (+ index corner))))))))))

(defun points->point-cloud (pose points &key (frame-id (symbol-value (find-symbol "*FIXED-FRAME*" :cram-tf))) (stamp 0.0))
  "A sensor_msgs/PointCloud of POINTS, 3d-vectors as they are seen from POSE."
  (let ((transform (cl-transforms:reference-transform pose)))
    (roslisp:make-message "sensor_msgs/PointCloud"
                          (:stamp :header) stamp (:frame_id :header) frame-id
                          :points (map 'vector
                                       (lambda (point)
                                         (message-of-point (cl-transforms:transform-point transform point) "geometry_msgs/Point32"))
                                       points))))

(defclass object-shape-data-mixin ()
  ((shape-type :initarg :shape-type :reader shape-type :documentation "A symbol, such as :BOX.")
   (dimensions :initarg :dimensions :reader dimensions :documentation "A 3d-vector."))
  (:documentation "For classes of data of objects of which a shape is known."))

(defclass object-mesh-data-mixin ()
  ((vertices :initarg :vertices :reader vertices :documentation "A sequence of 3d-vectors.")
   (faces :initarg :faces :reader faces :documentation "A sequence of lists of three numbers of vertices."))
  (:documentation "For classes of data of objects of which a mesh is known."))

(defclass object-point-data-mixin ()
  ((points :initarg :points :reader points :reader vertices :documentation "A sequence of 3d-vectors."))
  (:documentation "For classes of data of objects of which points are known."))

(defun solid-message (kind lengths)
  "A shape_msgs/SolidPrimitive. The numbers of kinds are those of the message."
  (roslisp:make-message "shape_msgs/SolidPrimitive"
                        :type (1+ (or (position kind '(:box :sphere :cylinder :cone)) (error "~s is not a kind of solid." kind)))
                        :dimensions (map 'vector #'identity lengths)))

(defgeneric get-shape-message (data)
  (:documentation "A message of shape_msgs, SolidPrimitive or Mesh, of the object that DATA tells of; nil if its shape is not known.")
  (:method (data) (declare (ignore data)) nil)
  (:method ((data object-shape-data-mixin))
    (solid-message (shape-type data) (numbers-of (dimensions data))))
  (:method ((data object-point-data-mixin))
    (solid-message :box (numbers-of (calculate-aabb (points data)))))
  (:method ((data object-mesh-data-mixin))
    (roslisp:make-message "shape_msgs/Mesh"
                          :triangles (map 'vector
                                          (lambda (face)
                                            (roslisp:make-message "shape_msgs/MeshTriangle" :vertex_indices (coerce face 'vector)))
                                          (faces data))
                          :vertices (map 'vector (lambda (point) (message-of-point point "geometry_msgs/Point")) (vertices data)))))
