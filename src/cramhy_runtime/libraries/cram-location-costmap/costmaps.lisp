;;;; Generic functions and conditions of costmaps: what programs extend by methods of their own.

(in-package #:cram-location-costmap)

(define-condition no-cost-functions-registered (error) ()
  (:report "The costmap has no cost functions. Register one: (register-cost-function costmap function name).")
  (:documentation "The values of a costmap were wanted before anything said what they are."))

(defgeneric costmap-generator-name->score (name)
  (:documentation "How early the cost functions of a name are computed: those with a high score first. A number is its own score.")
  (:method ((name number)) name))

(defgeneric generate (generator map occupancy-grid-metadata)
  (:documentation "The matrix MAP (rows are y) times the costs that GENERATOR gives on the grid of OCCUPANCY-GRID-METADATA.")
  (:method ((generator costmap-generator) map occupancy-grid-metadata)
    (%generate-by-function generator map occupancy-grid-metadata)))

(defun generate-height (map x y &optional (default 0.0d0))
  "One of the heights that the generators of MAP say for a place, drawn by chance; DEFAULT where they say none."
  (let ((heights (and (%has-height-generators map) (%heights-at map x y))))
    (if heights (random-elt heights) default)))

(defun angle-to-point-direction (x y position)
  "The direction from the place X, Y to POSITION, a pose or a 3d-vector: radians around the z axis."
  (let ((point (if (typep position 'cl-transforms:pose) (origin position) position)))
    (atan (- (y point) y) (- (x point) x))))

(define-hook on-visualize-costmap (costmap)
  (:documentation "Called with each costmap that places are drawn from."))

(define-hook on-visualize-costmap-sample (point)
  (:documentation "Called with each place that is drawn, a 3d-vector."))

(defvar *height-tolerance* 0.001
  "How many metres a pose may be above or below what height generators say: a millimetre, as CRAM's branch master has it. Facts that name
an environment, as in the branch devel, make it a centimetre.")

(defvar *z-padding* 1.0 "How many metres above the floor costmaps are shown.")
