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

(define-hook on-visualize-costmap (costmap)
  (:documentation "Called with each costmap that places are drawn from."))

(define-hook on-visualize-costmap-sample (point)
  (:documentation "Called with each place that is drawn, a 3d-vector."))

(defvar *z-padding* 1.0 "How many metres above the floor costmaps are shown.")
