;;;; cl-urdf: what a URDF file tells. A robot is a description of ROBOT-WORLD; its links and joints are objects of this package, made
;;;; when they are first asked for.

(defpackage #:cl-urdf
  (:use #:common-lisp)
  (:export #:robot #:parse-urdf #:name #:links #:joints #:root-link
           #:link #:from-joint #:to-joints #:inertial #:mass #:visual #:collision #:material #:geometry #:origin
           #:joint #:joint-type #:axis #:limits #:parent #:child #:lower #:upper #:effort #:velocity #:mimics #:joint-limits
           #:box #:size #:cylinder #:radius #:cylinder-length #:sphere #:mesh #:filename #:scale))

(in-package #:cl-urdf)

(eval-when (:compile-toplevel :load-toplevel :execute)
  (setf (find-class 'robot) (find-class 'robot-world:description)
        (class-name (find-class 'robot-world:description)) 'robot))

(defclass named ()
  ((name :initarg :name :reader name)))

(defmethod print-object ((object named) stream)
  (print-unreadable-object (object stream :type t)
    (princ (name object) stream)))

(defmethod print-object ((object robot) stream)
  (print-unreadable-object (object stream :type t)
    (princ (name object) stream)))

(defclass link (named)
  ((from-joint :initform nil :reader from-joint :documentation "The joint that leads to it; nil for the root.")
   (to-joints :initform nil :reader to-joints :documentation "The joints that begin at it.")
   (inertial :initarg :inertial :reader inertial)
   (collision :initarg :collision :reader collision :documentation "The first of its shapes, or nil.")
   (collisions :initarg :collisions :reader collisions :documentation "All its shapes."))
  (:documentation "A rigid part of a robot."))

(defgeneric visual (link)
  (:documentation "What is seen of a link: here the shapes that count in collisions.")
  (:method ((link link)) (collision link)))

(defclass inertial ()
  ((mass :initarg :mass :reader mass))
  (:documentation "What a link weighs, in kilograms."))

(defclass joint (named)
  ((joint-type :initarg :joint-type :reader joint-type :documentation ":FIXED, :REVOLUTE, :CONTINUOUS or :PRISMATIC.")
   (origin :initarg :origin :reader origin :documentation "Where the child is at 0, a transform.")
   (axis :initarg :axis :reader axis :documentation "A 3d-vector in the frame of the child.")
   (limits :initarg :limits :reader limits :documentation "Nil for a joint that has none.")
   (mimics :initarg :mimics :reader mimics :documentation "The name of the joint that it follows, or nil.")
   (parent :initarg :parent :reader parent)
   (child :initarg :child :reader child))
  (:documentation "How one link moves against another."))

(defclass joint-limits ()
  ((lower :initarg :lower :reader lower)
   (upper :initarg :upper :reader upper)
   (effort :initarg :effort :reader effort)
   (velocity :initarg :velocity :reader velocity))
  (:documentation "What a joint can do; nil is for what the file does not say."))

(defclass collision ()
  ((origin :initarg :origin :reader origin)
   (geometry :initarg :geometry :reader geometry))
  (:documentation "A shape of a link, and where it is in the link."))

(defclass box () ((size :initarg :size :reader size :documentation "Its lengths, a 3d-vector.")))
(defclass cylinder () ((radius :initarg :radius :reader radius) (length :initarg :length :reader cylinder-length)))
(defclass sphere () ((radius :initarg :radius :reader radius)))
(defclass mesh () ((filename :initarg :filename :reader filename) (scale :initarg :scale :reader scale)))

;;; Reading.

(defgeneric parse-urdf (input)
  (:documentation "The robot that a text or a file of URDF tells of.")
  (:method ((input string)) (robot-world:read-description input))
  (:method ((input pathname))
    (if (equalp (pathname-type input) "xacro")
        (robot-world:read-description (robot-world:description-text (namestring (truename input))) (namestring input))
        (with-open-file (stream input)
          (parse-urdf stream))))
  (:method ((input stream))
    (robot-world:read-description
     (with-output-to-string (text)
       (loop for line = (read-line input nil) while line do (write-line line text)))
     (let ((file (ignore-errors (pathname input)))) (if file (namestring file) "")))))

(defun pose->transform (pose)
  (cl-transforms:make-transform (cl-transforms:origin pose) (cl-transforms:orientation pose)))

(defun make-geometry (kind size file)
  (ecase kind
    (:box (make-instance 'box :size (apply #'cl-transforms:make-3d-vector size)))
    (:cylinder (make-instance 'cylinder :radius (first size) :length (second size)))
    (:sphere (make-instance 'sphere :radius (first size)))
    (:mesh (make-instance 'mesh :filename file :scale (apply #'cl-transforms:make-3d-vector size)))))

(defun make-link (name mass shapes)
  (let ((collisions (loop for (kind size pose file) in shapes
                          collect (make-instance 'collision :origin (pose->transform pose) :geometry (make-geometry kind size file)))))
    (make-instance 'link :name name :inertial (make-instance 'inertial :mass mass) :collision (first collisions) :collisions collisions)))

(defun make-tables (robot)
  "A list of two hash tables: the links and the joints of ROBOT, by their names."
  (let ((links (make-hash-table :test 'equal))
        (joints (make-hash-table :test 'equal)))
    (loop for (name mass shapes) in (robot-world:description-links robot)
          do (setf (gethash name links) (make-link name mass shapes)))
    (loop for (name kind parent child pose axis lower upper velocity effort mimic) in (robot-world:description-joints robot)
          for above = (gethash parent links)
          for below = (gethash child links)
          for joint = (make-instance 'joint
                        :name name :joint-type kind :origin (pose->transform pose) :axis axis :mimics mimic
                        :parent above :child below
                        :limits (when (or lower upper velocity effort)
                                  (make-instance 'joint-limits :lower lower :upper upper :velocity velocity :effort effort)))
          do (setf (gethash name joints) joint
                   (slot-value below 'from-joint) joint
                   (slot-value above 'to-joints) (append (slot-value above 'to-joints) (list joint))))
    (list links joints)))

(defvar *tables* (make-hash-table :test 'eq :weakness :key)
  "The links and joints of robots that were asked for.")

(defun tables (robot)
  (or (gethash robot *tables*)
      (setf (gethash robot *tables*) (make-tables robot))))

(defmethod name ((robot robot)) (robot-world:description-name robot))

(defgeneric links (robot)
  (:documentation "A hash table of the links of ROBOT by their names.")
  (:method ((robot robot)) (first (tables robot))))

(defgeneric joints (robot)
  (:documentation "A hash table of the joints of ROBOT by their names.")
  (:method ((robot robot)) (second (tables robot))))

(defgeneric root-link (robot)
  (:documentation "The link of ROBOT that no joint leads to.")
  (:method ((robot robot))
    (loop for link being the hash-values of (links robot)
          unless (from-joint link) return link)))
