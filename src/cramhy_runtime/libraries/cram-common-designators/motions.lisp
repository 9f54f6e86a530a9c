;;;; What motions ask of process modules: (a motion (type going) (target ?place)) resolves to (MOVE-BASE pose), and so on.

(defpackage #:cram-common-designators
  (:use #:common-lisp #:cram-prolog #:cram-designators #:cram-designator-specification)
  (:export #:move-base #:move-torso #:move-head #:detect #:inspect #:move-gripper-joint #:move-tcp #:move-joints
           #:move-with-constraints))

(in-package #:cram-common-designators)

(def-fact-group targets ()

  (<- (solution ?location ?pose)
    (current-designator ?location ?current)
    (designator-groundings ?current ?poses)
    (member ?pose ?poses))

  (<- (solution-or-nil ?designator ?key ?pose)
    (once (or (and (property ?designator (?key ?location)) (solution ?location ?pose))
              (equal ?pose nil))))

  (<- (value-or-nil ?designator ?key ?value)
    (once (or (desig-prop ?designator (?key ?value))
              (equal ?value nil))))

  (<- (current-object ?designator ?current)
    (property ?designator (:object ?object))
    (current-designator ?object ?current)))

(def-fact-group base-and-torso-motions (motion-grounding)

  (<- (motion-grounding ?designator (move-base ?pose))
    (property ?designator (:type :going))
    (property ?designator (:target ?location))
    (solution ?location ?pose))

  (<- (motion-grounding ?designator (move-torso ?angle))
    (property ?designator (:type :moving-torso))
    (property ?designator (:joint-angle ?angle))))

(def-fact-group head-motions (motion-grounding)

  (<- (motion-grounding ?designator (move-head :pose ?pose))
    (property ?designator (:type :looking))
    (property ?designator (:target ?location))
    (solution ?location ?pose))

  (<- (motion-grounding ?designator (move-head :frame ?frame))
    (property ?designator (:type :looking))
    (property ?designator (:frame ?frame)))

  (<- (motion-grounding ?designator (move-head :direction ?direction))
    (property ?designator (:type :looking))
    (property ?designator (:direction ?direction))))

(def-fact-group perception-motions (motion-grounding)

  (<- (motion-grounding ?designator (detect ?object))
    (property ?designator (:type :detecting))
    (current-object ?designator ?object))

  (<- (motion-grounding ?designator (inspect ?object))
    (property ?designator (:type :inspecting))
    (current-object ?designator ?object)))

(def-fact-group gripper-motions (motion-grounding)

  (<- (motion-grounding ?designator (move-gripper-joint :open ?gripper))
    (property ?designator (:type :opening))
    (property ?designator (:gripper ?gripper)))

  (<- (motion-grounding ?designator (move-gripper-joint :close ?gripper))
    (property ?designator (:type :closing))
    (property ?designator (:gripper ?gripper)))

  (<- (motion-grounding ?designator (move-gripper-joint :grip ?gripper ?effort))
    (property ?designator (:type :gripping))
    (property ?designator (:gripper ?gripper))
    (value-or-nil ?designator :effort ?effort))

  (<- (motion-grounding ?designator (move-gripper-joint ?position ?gripper nil))
    (property ?designator (:type :moving-gripper-joint))
    (property ?designator (:gripper ?gripper))
    (property ?designator (:joint-angle ?position))))

(def-fact-group arm-motions (motion-grounding)

  (<- (motion-grounding ?designator (move-tcp ?left-pose ?right-pose ?collision-mode))
    (property ?designator (:type :moving-tcp))
    (solution-or-nil ?designator :left-target ?left-pose)
    (solution-or-nil ?designator :right-target ?right-pose)
    (value-or-nil ?designator :collision-mode ?collision-mode))

  (<- (motion-grounding ?designator (move-joints ?left ?right))
    (property ?designator (:type :moving-arm-joints))
    (value-or-nil ?designator :left-configuration ?left)
    (value-or-nil ?designator :right-configuration ?right))

  (<- (motion-grounding ?designator (move-with-constraints ?constraints))
    (property ?designator (:type :moving-with-constraints))
    (desig-prop ?designator (:constraints ?constraints))))
