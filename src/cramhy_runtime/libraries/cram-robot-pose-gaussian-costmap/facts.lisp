;;;; The costmaps: a normal distribution around what is to be reached or seen, and rings by the settings of the application. Where a
;;;; setting is missing, the rule gives no costmap.

(in-package #:cram-robot-pose-guassian-costmap)

(defclass range-generator () ()
  (:documentation "A name for a ring. Each is a name of its own, so that the rings of several poses all count."))
(defclass range-include-generator (range-generator) ())
(defclass range-exclude-generator (range-generator) ())

(defmethod costmap-generator-name->score ((name range-include-generator)) 7)
(defmethod costmap-generator-name->score ((name range-exclude-generator)) 6)
(defmethod costmap-generator-name->score ((name (eql 'pose-distribution))) 5)
(defmethod costmap-generator-name->score ((name (eql 'reachable-from-range))) 5)
(defmethod costmap-generator-name->score ((name (eql 'reachable-from-distribution))) 4)

(defun starting-place (from)
  "Where a thing is that a place is to be reachable from: a pose or point, or the name of the robot."
  (if (symbolp from) (cram-tf:robot-current-pose) (in-fixed-frame from)))

(def-fact-group robot-pose-gaussian-costmap (desig-costmap)

  (<- (within ?distance () ?costmap))

  (<- (within ?distance (?place . ?places) ?costmap)
    (instance-of range-include-generator ?name)
    (costmap-add-function ?name (make-range-cost-function ?place ?distance) ?costmap)
    (within ?distance ?places ?costmap))

  (<- (beyond ?distance () ?costmap))

  (<- (beyond ?distance (?place . ?places) ?costmap)
    (instance-of range-exclude-generator ?name)
    (costmap-add-function ?name (make-range-cost-function ?place ?distance :invert t) ?costmap)
    (beyond ?distance ?places ?costmap))

  (<- (around ?places ?costmap)
    (lisp-fun 2d-pose-covariance ?places 0.5 (?mean ?covariance))
    (costmap-add-function pose-distribution (make-gauss-cost-function ?mean ?covariance) ?costmap)
    (orientation-samples ?samples)
    (orientation-sample-step ?step)
    (costmap-add-orientation-generator
     (make-angle-to-point-generator ?mean :samples ?samples :sample-step ?step) ?costmap)
    (costmap-add-height-generator (make-constant-height-function 0.0) ?costmap))

  (<- (desig-costmap ?designator ?costmap)
    (target-places ?designator :see ?places)
    (visibility-costmap-size ?distance)
    (once (costmap ?costmap))
    (once (around ?places ?costmap))
    (once (within ?distance ?places ?costmap)))

  (<- (desig-costmap ?designator ?costmap)
    (target-places ?designator :reach ?places)
    (costmap-in-reach-distance ?distance)
    (costmap-reach-minimal-distance ?minimal-distance)
    (once (costmap ?costmap))
    (once (around ?places ?costmap))
    (once (within ?distance ?places ?costmap))
    (once (beyond ?minimal-distance ?places ?costmap)))

  (<- (desig-costmap ?designator ?costmap)
    (desig-prop ?designator (:reachable-from ?from))
    (lisp-fun starting-place ?from ?place)
    (costmap-in-reach-distance ?distance)
    (once (costmap ?costmap))
    (costmap-add-function reachable-from-range (make-range-cost-function ?place ?distance) ?costmap)
    (costmap-add-function reachable-from-distribution (make-location-cost-function ?place ?distance) ?costmap)))
