;;;; Actions that move one thing: which plan each stands for.

(in-package #:cram-mobile-pick-place-plans)

(def-fact-group optional-entries ()

  (<- (entry-or-nil ?designator ?key ?value)
    (once (or (spec:property ?designator (?key ?value))
              (equal ?value nil)))))

(def-fact-group base-and-camera-actions (desig:action-grounding)

  (<- (desig:action-grounding ?designator (go-to-target ?location))
    (spec:property ?designator (:type :going))
    (spec:property ?designator (:target ?location)))

  (<- (desig:action-grounding ?designator (perceive ?object))
    (spec:property ?designator (:type :detecting))
    (spec:property ?designator (:object ?object)))

  (<- (desig:action-grounding ?designator (look-at ?key ?value))
    (spec:property ?designator (:type :looking))
    (member ?key (:target :frame :direction :object))
    (desig:desig-prop ?designator (?key ?given))
    (looked-at ?key ?given ?value)
    (once (or (not (desig:desig-prop ?designator (:camera ?camera)))
              (spec:property ?designator (:camera :head)))))

  (<- (looked-at :object ?object ?current)
    (desig:current-designator ?object ?current))

  (<- (looked-at ?key ?value ?value)
    (not (== ?key :object))))

(def-fact-group body-actions (desig:action-grounding)

  (<- (desig:action-grounding ?designator (move-torso ?position))
    (spec:property ?designator (:type :moving-torso))
    (desig:desig-prop ?designator (:joint-angle ?position)))

  (<- (desig:action-grounding ?designator (park-arms . ?arguments))
    (spec:property ?designator (:type :parking-arms))
    (-> (desig:desig-prop ?designator (:arms ?arms))
        (equal ?arguments (:arm ?arms))
        (equal ?arguments ())))

  (<- (desig:action-grounding ?designator (position-arms ?left ?right))
    (spec:property ?designator (:type :positioning-arm))
    (configuration-or-nil ?designator :left-configuration ?left)
    (configuration-or-nil ?designator :right-configuration ?right))

  (<- (configuration-or-nil ?designator ?key ?configuration)
    (once (or (desig:desig-prop ?designator (?key ?configuration))
              (equal ?configuration nil)))))

(def-fact-group arm-actions (desig:action-grounding)

  (<- (desig:action-grounding ?designator (move-arms-in-sequence ?left-poses ?right-poses))
    (member ?type (:reaching :retracting))
    (poses-of ?designator ?type ?left-poses ?right-poses))

  (<- (desig:action-grounding ?designator (move-arms-in-sequence ?left-poses ?right-poses :allow-hand))
    (poses-of ?designator :lifting ?left-poses ?right-poses))

  (<- (desig:action-grounding ?designator (move-arms-in-sequence ?left-poses ?right-poses :allow-all))
    (member ?type (:pulling :pushing :putting :grasping))
    (poses-of ?designator ?type ?left-poses ?right-poses))

  (<- (poses-of ?designator ?type ?left-poses ?right-poses)
    (spec:property ?designator (:type ?type))
    (entry-or-nil ?designator :left-poses ?left-poses)
    (entry-or-nil ?designator :right-poses ?right-poses)))

(def-fact-group gripper-actions (desig:action-grounding)

  (<- (desig:action-grounding ?designator (release ?gripper))
    (spec:property ?designator (:type :releasing))
    (spec:property ?designator (:gripper ?gripper)))

  (<- (desig:action-grounding ?designator (grip ?gripper ?effort))
    (spec:property ?designator (:type :gripping))
    (spec:property ?designator (:gripper ?gripper))
    (entry-or-nil ?designator :effort ?effort))

  (<- (desig:action-grounding ?designator (open-or-close-gripper ?gripper ?type))
    (member ?type (:opening :closing))
    (spec:property ?designator (:type ?type))
    (spec:property ?designator (:gripper ?gripper)))

  (<- (desig:action-grounding ?designator (open-or-close-gripper ?gripper ?motion))
    (member (?type ?motion) ((:opening-gripper :opening) (:closing-gripper :closing)))
    (spec:property ?designator (:type ?type))
    (spec:property ?designator (:gripper ?gripper)))

  (<- (desig:action-grounding ?designator (set-gripper-to-position ?gripper ?position))
    (spec:property ?designator (:type :setting-gripper))
    (spec:property ?designator (:gripper ?gripper))
    (spec:property ?designator (:position ?position))))
