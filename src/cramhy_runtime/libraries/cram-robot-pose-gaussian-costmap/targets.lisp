;;;; What a robot is to reach or to see: the poses of a designator, in the frame of costmaps.

(in-package #:cram-robot-pose-guassian-costmap)

(defun in-fixed-frame (place)
  "PLACE, a pose or a point, in the frame of costmaps."
  (let ((frame (or cram-tf:*fixed-frame* "map")))
    (typecase place
      (cl-transforms-stamped:pose-stamped (cram-tf:ensure-pose-in-frame place frame :use-zero-time t))
      (cl-transforms-stamped:point-stamped (cram-tf:ensure-point-in-frame place frame :use-zero-time t))
      (t place))))

(def-fact-group targets (to-see target-places)
  (<- (to-see ?designator ?pose)
    (desig-prop ?designator (:pose ?pose)))

  (<- (to-see ?designator ?pose)
    (member ?key (:object :obj))
    (desig-prop ?designator (?key ?object))
    (current-designator ?object ?current)
    (desig-location-prop ?current ?pose))

  (<- (to-see ?designator ?pose)
    (desig-prop ?designator (:location ?location))
    (current-designator ?location ?current)
    (lisp-fun reference ?current ?pose)
    (bound ?pose))

  (<- (target-places ?designator :reach ?places)
    (cram-robot-interfaces:reachability-designator ?designator)
    (findall ?place (and (cram-robot-interfaces:designator-reach-pose ?designator ?pose ?arm)
                         (lisp-fun in-fixed-frame ?pose ?place))
             ?places)
    (member ?_ ?places))

  (<- (target-places ?designator :see ?places)
    (cram-robot-interfaces:visibility-designator ?designator)
    (findall ?place (and (to-see ?designator ?pose) (lisp-fun in-fixed-frame ?pose ?place)) ?places)
    (member ?_ ?places)))
