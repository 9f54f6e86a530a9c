;;;; cram-physics-utils: where files of meshes are, and what is in them.

(defpackage #:cram-physics-utils
  (:nicknames #:physics-utils)
  (:use #:common-lisp #:cffi #:cffi-ros-utils)
  (:export #:parse-uri #:3d-model #:load-3d-model #:3d-model-dimensions))

(in-package #:cram-physics-utils)

(eval-when (:compile-toplevel :load-toplevel :execute)
  (setf (find-class '3d-model) (find-class 'robot-world:mesh)
        (class-name (find-class 'robot-world:mesh)) '3d-model))

(defun parse-uri (uri)
  "The pathname that URI means: package://PACKAGE/PATH lies in a ROS package, anything else is a path. Nil when there is no such package.
Wildcards stay as they are."
  (let ((path (robot-world:path-of-address (if (pathnamep uri) (namestring uri) uri))))
    (and path (pathname path))))

(defun load-3d-model (uri &key flip-winding-order (remove-identical-vertices t))
  "The mesh in a file: STL, OBJ or Collada. The keywords do not matter here: a mesh counts as its convex hull."
  (declare (ignore flip-winding-order remove-identical-vertices))
  (robot-world:read-mesh (if (pathnamep uri) (namestring uri) uri)))

(defun 3d-model-dimensions (model)
  "The lengths of the box around MODEL, a 3d-vector."
  (robot-world:mesh-size model))
