;;;; cram-occupancy-grid-costmap: places of a robot lie on what the topic "map" shows as free. Without a map the costmap has no cost
;;;; functions, and merging it with others changes nothing.

(defpackage #:cram-occupancy-grid-costmap
  (:nicknames #:occupancy-grid-costmap)
  (:use #:common-lisp #:cram-designators #:cram-location-costmap #:cram-prolog))

(in-package #:cram-occupancy-grid-costmap)

(defvar *map* (cpl:make-fluent :name 'map :value nil)
  "The last nav_msgs/OccupancyGrid of the topic.")

(defvar *map-subscriber* nil)

(defun init-occupancy-grid ()
  "Listen to the topic of the map."
  (setf *map-subscriber*
        (roslisp:subscribe "map" "nav_msgs/OccupancyGrid" (lambda (message) (setf (cpl:value *map*) message)))))

(defun destroy-occupancy-grid ()
  "Forget the map."
  (setf *map-subscriber* nil
        (cpl:value *map*) nil))

(roslisp-utilities:register-ros-init-function init-occupancy-grid)
(roslisp-utilities:register-ros-cleanup-function destroy-occupancy-grid)

(defmethod costmap-generator-name->score ((name (eql 'static-occupied))) 15)
(defmethod costmap-generator-name->score ((name (eql 'free-space))) 15)

(def-fact-group occupancy-grid-costmap (desig-costmap)

  (<- (stands-on-floor ?designator)
    (cram-robot-interfaces:reachability-designator ?designator))

  (<- (stands-on-floor ?designator)
    (cram-robot-interfaces:visibility-designator ?designator))

  (<- (restricted-to-map ?costmap)
    (global-fluent-value *map* ?message)
    (lisp-pred identity ?message)
    (costmap-padding ?padding)
    (occupancy-grid ?message ?occupied (padding ?padding))
    (costmap-add-function static-occupied (make-occupancy-grid-cost-function ?occupied :invert t) ?costmap)
    (inverted-occupancy-grid ?message ?free)
    (costmap-add-function free-space (make-occupancy-grid-cost-function ?free) ?costmap))

  (<- (desig-costmap ?designator ?costmap)
    (once (stands-on-floor ?designator))
    (once (costmap ?costmap))
    (once (or (restricted-to-map ?costmap) (true)))))
