;;;; Delivering.

(in-package #:cram-pr2-fetch-deliver-plans)

(defun placing (place-action ?object ?target)
  "The action of putting an object down at ?TARGET, by the arm of PLACE-ACTION where that has one."
  (let ((?arm (and place-action (desig:desig-prop-value place-action :arm)))
        (?object (desig:current-desig ?object)))
    (desig:an action
              (type placing)
              (desig:when ?arm (arm ?arm))
              (object ?object)
              (target ?target))))

(defun put-down (object ?target place-action)
  "Look where an object goes, find out how it gets there, put it there, and park the arms."
  (exe:perform (desig:an action (type turning-towards) (target ?target)))
  (let ((action (placing place-action object ?target)))
    (pr2-proj-reasoning:check-placing-collisions action)
    (exe:perform (desig:current-desig action))
    (pp-plans:park-arms)))

(defun settle-on-place-to-deliver-from (location object target place-action)
  "Move LOCATION on to a solution from which OBJECT can be put at TARGET as far as is known."
  (or (pr2-proj-reasoning:settle-on-place
       location (lambda ()
                  (look-ahead-to (desig:reference target))
                  (pr2-proj-reasoning:check-placing-collisions (placing place-action object target))))
      (cpl:fail 'common-fail:object-undeliverable :object object :description "The target is out of reach from all of the places ahead.")))

;;; The plan for placing passes over a failure of its last motion, as the original does, and what was pushed may fall. So the world is asked.

(defparameter *most-beside* 0.05
  "How far beside its target an object may come to stand, metres.")

(defparameter *most-below* 0.1
  "How far below its target, since a target may be a little above the table, metres.")

(defparameter *most-tilted* 0.5
  "How much an object may be tilted against its target, radians.")

(defun upwards (pose)
  (cl-transforms:rotate (cl-transforms:orientation pose) (cl-transforms:make-3d-vector 0 0 1)))

(defparameter *most-pushed* 0.4
  "How far away from its target an object is worth taking again, metres; one that fell to the floor is not.")

(defun where-it-lies (object target)
  "(the pose of OBJECT in the world, the one that TARGET, a location, has for it), or nil where no world knows the object."
  (let ((item (btr-belief:get-designator-object (desig:current-desig object))))
    (when item
      (list (btr:pose item)
            (cram-tf:ensure-pose-in-frame (desig:reference target) cram-tf:*fixed-frame* :use-zero-time t)))))

(defun settle-world ()
  "Let what falls or rolls in the current world come to rest, ten seconds at most."
  (btr:simulate btr:*current-bullet-world* 60))

(defun lies-at-p (object target)
  "Whether OBJECT lies where TARGET, a location, has it, and no hand holds it; true where no world knows it."
  (let ((poses (where-it-lies object target)))
    (or (null poses)
        (destructuring-bind (is wanted) poses
          (let ((way (cl-transforms:v- (cl-transforms:origin is) (cl-transforms:origin wanted))))
            (and (not (in-hand-p object))
                 (<= (abs (cl-transforms:x way)) *most-beside*)
                 (<= (abs (cl-transforms:y way)) *most-beside*)
                 (<= (- *most-below*) (cl-transforms:z way) *most-beside*)
                 (>= (cl-transforms:dot-product (upwards is) (upwards wanted)) (cos *most-tilted*))))))))

(defun worth-taking-again-p (object target)
  "Whether OBJECT lies near to TARGET, a location, though not at it."
  (let ((poses (where-it-lies object target)))
    (and poses
         (< (cl-transforms:v-dist (cl-transforms:origin (first poses)) (cl-transforms:origin (second poses))) *most-pushed*))))

(defun resolvable-p (designator)
  "Whether DESIGNATOR has a solution."
  (handler-case (and (desig:reference (desig:current-desig designator)) t)
    (desig:designator-error () nil)))

(defun target-within-reach (target)
  "TARGET, moved on to its next solution that the robot reaches from anywhere, with a location of the places for that; nil where it has none
among the next twenty. Two values."
  (loop repeat 20
        for place = (desig:current-desig target) then (next-solution place)
        while place
        do (let ((from (and (resolvable-p place) (place-to-reach-from place nil))))
             (when (and from (resolvable-p from))
               (return (values place from))))))

(cpl:def-cram-function deliver (?object-designator ?target-location ?target-robot-location place-action)
  "Go to where an object that is held shall be, and put it there. Where that is out of reach the robot goes to another place, five times,
and takes another solution of the target, twice from the same place, and twice with places of its own; solutions of the target that are
within reach from nowhere do not count. In the end the plan asks the world,
when it has come to rest, whether the object lies there."
  (flet ((give-up (description)
           (cpl:fail 'common-fail:object-undeliverable :object ?object-designator :description description))
         (next-target ()
           (let ((next (next-solution ?target-location)))
             (when next (setf ?target-location next)))))
    (unless (resolvable-p ?target-robot-location)
      (multiple-value-bind (target from) (target-within-reach ?target-location)
        (when target
          (setf ?target-location target
                ?target-robot-location from))))
    (with-other-solutions (2 (fd-plans deliver) desig:designator-error common-fail:object-undeliverable)
        ((when (next-target)
           (multiple-value-bind (target from) (target-within-reach ?target-location)
             (setf ?target-location (or target ?target-location)
                   ?target-robot-location (or from (place-to-reach-from ?target-location nil)))))
         (give-up "The object cannot be put at any of the places that were tried."))
      (with-other-solutions (5 (fd-plans deliver)
                             common-fail:navigation-goal-in-collision
                             common-fail:object-undeliverable
                             common-fail:manipulation-low-level-failure)
          ((let ((elsewhere (next-solution ?target-robot-location)))
             (when elsewhere (setf ?target-robot-location elsewhere)))
           (give-up "The target was not reached from any of the places that were tried."))
        (settle-on-place-to-deliver-from ?target-robot-location ?object-designator ?target-location place-action)
        (exe:perform (desig:an action (type navigating) (location ?target-robot-location)))
        (with-other-solutions (2 (fd-plans deliver) common-fail:looking-high-level-failure common-fail:object-unreachable)
            ((next-target)
             (give-up "The target is not to be seen or reached from here."))
          (put-down ?object-designator ?target-location place-action))))
    (settle-world)
    (unless (lies-at-p ?object-designator ?target-location)
      (give-up "The object was put down, but does not lie where it was to be.")))
  nil)
