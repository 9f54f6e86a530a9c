;;;; Objects: where they were seen, and the kinds that they are of. The property :POSE of an object that was seen is a list of the entries
;;;; (:POSE stamped-pose) and (:TRANSFORM stamped-transform), both in the frame of the robot's base.

(in-package #:cram-object-interfaces)

(defun seen (object-designator entry)
  "An entry of the property :POSE of an object, or nil."
  (second (assoc entry (desig:desig-prop-value object-designator :pose))))

(defun get-object-pose (object-designator)
  "Where an object was seen: a stamped pose in the frame of the robot's base, or nil."
  (seen object-designator :pose))

(defun get-object-transform (object-designator)
  "Where an object was seen: the transform from the robot's base to it, or nil."
  (seen object-designator :transform))

(def-fact-group object-designators (desig:location-grounding desig:desig-location-prop)

  (<- (desig:desig-location-prop ?object ?pose)
    (desig:obj-desig? ?object)
    (lisp-fun get-object-pose ?object ?pose)
    (lisp-pred identity ?pose))

  (<- (desig:location-grounding ?designator ?pose)
    (desig:loc-desig? ?designator)
    (desig:current-designator ?designator ?current)
    (desig:desig-prop ?current (:of ?object))
    (desig:current-designator ?object ?current-object)
    (lisp-fun get-object-pose ?current-object ?pose)
    (lisp-pred identity ?pose)))

(def-fact-group kinds-of-objects (object-type-direct-subtype object-rotationally-symmetric orientation-matters)

  (<- (object-type-direct-subtype ?type ?subtype)
    (fail))

  (<- (object-type-subtype ?type ?type))

  (<- (object-type-subtype ?type ?subtype)
    (object-type-direct-subtype ?type ?between)
    (object-type-subtype ?between ?subtype))

  (<- (object-rotationally-symmetric ?type)
    (fail))

  (<- (orientation-matters ?type)
    (fail)))
