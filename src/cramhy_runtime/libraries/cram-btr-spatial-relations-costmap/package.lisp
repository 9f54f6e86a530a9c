;;;; cram-btr-spatial-relations-costmap: what ON, IN, LEFT-OF, NEAR and their like mean in the current world. The package exports nothing:
;;;; it is used by writing (a location (on ...) ...).

(defpackage #:cram-btr-spatial-relations-costmap
  (:nicknames #:btr-spatial-cm)
  (:use #:common-lisp #:cram-prolog))

(in-package #:cram-btr-spatial-relations-costmap)

(defmacro define-scores (&rest names-and-scores)
  "Say how early the cost functions of these names are computed."
  `(progn
     ,@(loop for (name score) in names-and-scores
             collect `(defmethod location-costmap:costmap-generator-name->score ((name (eql ',name))) ,score))))

(define-scores (supporting-object 9) (potential-field 7) (slot-generator 6) (on-bounding-box 5) (side 5) (environment-free-space 4)
  (near-distribution 4) (range 2))

(defclass ring-generator () ()
  (:documentation "A name for a ring. Each is a name of its own, so that those of several things all count."))

(defmethod location-costmap:costmap-generator-name->score ((name ring-generator)) 6)
