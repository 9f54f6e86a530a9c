;;;; cram-physics-utils: where files of meshes are, and what is in them.

(defpackage #:cram-physics-utils
  (:nicknames #:physics-utils)
  (:use #:common-lisp #:cffi #:cffi-ros-utils)
  (:export #:parse-uri #:load-3d-model #:3d-model #:make-3d-model #:3d-model-vertices #:3d-model-faces #:3d-model-dimensions
           #:face #:make-face #:face-points #:face-normals #:fix-normals
           #:calculate-aabb #:scale-3d-model #:resize-3d-model #:transform-3d-model #:calculate-mass
           #:shape-msg->points #:shape-msg->mesh #:points->point-cloud #:get-shape-message
           #:object-shape-data-mixin #:object-mesh-data-mixin #:object-point-data-mixin
           #:shape-type #:dimensions #:vertices #:faces #:points
           #:event-queue #:post-event #:get-next-event #:wait-for-queue-empty))

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
