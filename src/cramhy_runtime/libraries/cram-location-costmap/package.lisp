;;;; cram-location-costmap: grids of probabilities for location designators. What computes is written in Python (the room
;;;; robot_world/costmaps); here are the generic functions, the facts, the messages, and how designators find places.

(defpackage #:cram-location-costmap
  (:nicknames #:location-costmap #:costmap)
  (:use #:common-lisp #:cram-prolog #:cram-utilities #:roslisp-utilities #:alexandria #:roslisp #:cram-designators
        #:cl-transforms-stamped)
  (:shadowing-import-from #:cl-transforms #:rotate)
  (:export
   ;; grids
   #:occupancy-grid #:2d-value-map #:lazy-2d-value-map #:grid-width #:grid-height #:origin-x #:origin-y #:resolution #:width #:height
   #:2d-value-map-lookup #:2d-value-map-set #:make-padding-mask #:point-in-padding-mask-p #:occupancy-grid-put-mask
   #:map-coordinate->array-index #:array-index->map-coordinate #:*z-padding* #:padding
   ;; costmaps
   #:location-costmap #:costmap-generator #:map-costmap-generator #:function-costmap-generator #:generator-name #:generator-function
   #:cost-functions #:generators #:generate #:register-cost-function #:get-cost-map #:get-map-value #:gen-costmap-sample-point
   #:costmap-samples #:register-orientation-generator #:register-height-generator #:merge-costmaps
   #:costmap-generator-name->score #:no-cost-functions-registered #:on-visualize-costmap #:on-visualize-costmap-sample
   ;; functions for them
   #:make-gauss-cost-function #:make-location-cost-function #:make-range-cost-function #:make-axis-boundary-cost-function
   #:make-occupancy-grid-cost-function #:make-padded-costmap-cost-function #:make-matrix-cost-function
   #:make-constant-height-function #:make-orientation-generator #:make-angle-to-point-generator #:angle-to-point-direction
   #:generate-height
   ;; statistics
   #:occupancy-grid-mean #:occupancy-grid-covariance #:2d-cov #:points-mean #:points-cov #:2d-pose-covariance
   ;; messages
   #:grid-cells-msg->occupancy-grid #:grid-cells-msg->height-map #:occupancy-grid-msg->occupancy-grid #:occupancy-grid-msg-metadata
   #:occupancy-grid->grid-cells-msg #:publish-location-costmap #:publish-point #:publish-pose #:location-costmap->collision-map
   ;; Prolog
   #:costmap #:costmap-metadata #:costmap-add-function #:costmap-add-heightmap #:costmap-add-height-generator
   #:costmap-add-cached-height-generator #:costmap-add-orientation-generator #:costmap-add-cached-orientation-generator
   #:desig-costmap #:merged-desig-costmap #:global-fluent-value #:inverted-occupancy-grid
   ;; settings
   #:costmap-size #:costmap-origin #:costmap-resolution #:costmap-padding #:costmap-manipulation-padding #:costmap-in-reach-distance
   #:costmap-in-reach-padding #:costmap-reach-minimal-distance #:visibility-costmap-size #:orientation-samples
   #:orientation-sample-step #:reachability-orientation-offset #:visibility-orientation-offset
   ;; designators
   #:*costmap-valid-solution-threshold* #:reset-costmap-cache))

(in-package #:cram-location-costmap)

(cramhy::define-costmaps)
