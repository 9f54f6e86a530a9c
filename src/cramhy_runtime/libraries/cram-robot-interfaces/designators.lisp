;;;; Designators that are about a robot: places to reach or to see something from, trajectories, constraints.

(in-package #:cram-robot-interfaces)

(def-fact-group reachability-designators (reachability-designator visibility-designator designator-reach-pose)

  (<- (reachability-designator ?designator)
    (loc-desig? ?designator)
    (desig-prop ?designator (:reachable-for ?robot)))

  (<- (visibility-designator ?designator)
    (loc-desig? ?designator)
    (desig-prop ?designator (:visible-for ?robot)))

  (<- (designator-reach-pose ?designator ?pose ?arm)
    (once (pose-to-reach ?designator ?pose))
    (once (or (desig-prop ?designator (:arm ?arm))
              (and (robot ?robot) (arm ?robot ?arm)))))

  (<- (pose-to-reach ?designator ?pose)
    (desig-prop ?designator (:pose ?pose)))

  (<- (pose-to-reach ?designator ?point)
    (member ?key (:object :obj))
    (desig-prop ?designator (?key ?object))
    (current-designator ?object ?current)
    (desig-location-prop ?current ?pose)
    (lisp-fun cl-transforms:origin ?pose ?point))

  (<- (pose-to-reach ?designator ?pose)
    (desig-prop ?designator (:location ?location))
    (current-designator ?location ?current)
    (desig-reference ?current ?pose)))

(def-fact-group manipulation-designators (trajectory-desig? constraints-desig?)

  (<- (trajectory-desig? ?designator)
    (action-desig? ?designator)
    (desig-prop ?designator (:type :trajectory)))

  (<- (constraints-desig? ?designator)
    (action-desig? ?designator)
    (desig-prop ?designator (:type :constraints))))

(defun reachability-designator-p (designator)
  "Whether DESIGNATOR is a place from which a robot reaches something."
  (and (prolog `(reachability-designator ,designator)) t))

(defun visibility-designator-p (designator)
  "Whether DESIGNATOR is a place from which a robot sees something."
  (and (prolog `(visibility-designator ,designator)) t))
