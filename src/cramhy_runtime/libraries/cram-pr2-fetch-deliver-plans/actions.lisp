;;;; Which actions the plans are for.

(in-package #:cram-pr2-fetch-deliver-plans)

(defun arm-for-furniture ()
  "The arm that opens and closes furniture where none is said: the left one, unless it holds something and another one is free."
  (let ((free (btr::free-arms)))
    (if (or (null free) (member :left free)) :left (first free))))

(def-fact-group fetch-and-deliver-designators (desig:action-grounding)

  (<- (entry-or-nil ?designator ?key ?value)
    (once (or (spec:property ?designator (?key ?value))
              (equal ?value nil))))

  (<- (current-entry ?designator ?key ?current)
    (once (desig:desig-prop ?designator (?key ?value)))
    (desig:current-designator ?value ?current))

  (<- (current-entry-or-nil ?designator ?key ?current)
    (once (or (current-entry ?designator ?key ?current)
              (equal ?current nil))))

  (<- (desig:action-grounding ?designator (go-without-collisions ?location))
    (spec:property ?designator (:type :navigating))
    (current-entry ?designator :location ?location))

  (<- (desig:action-grounding ?designator (turn-towards ?target))
    (spec:property ?designator (:type :turning-towards))
    (current-entry ?designator :target ?target))

  (<- (desig:action-grounding ?designator (search-for-object ?object ?location))
    (spec:property ?designator (:type :searching))
    (current-entry ?designator :object ?object)
    (current-entry ?designator :location ?location))

  (<- (desig:action-grounding ?designator (fetch ?object ?arm ?robot-location ?pick-up-action))
    (spec:property ?designator (:type :fetching))
    (current-entry ?designator :object ?object)
    (entry-or-nil ?designator :arm ?arm)
    (once (or (current-entry ?designator :robot-location ?robot-location)
              (and (lisp-fun place-of ?object ?place)
                   (lisp-fun place-to-reach-from ?place ?arm ?robot-location))))
    (current-entry-or-nil ?designator :pick-up-action ?pick-up-action))

  (<- (desig:action-grounding ?designator (deliver ?object ?target ?robot-location ?place-action))
    (spec:property ?designator (:type :delivering))
    (current-entry ?designator :object ?object)
    (entry-or-nil ?designator :arm ?arm)
    (current-entry ?designator :target ?target)
    (once (or (current-entry ?designator :robot-location ?robot-location)
              (lisp-fun place-to-reach-from ?target ?arm ?robot-location)))
    (current-entry-or-nil ?designator :place-action ?place-action))

  (<- (desig:action-grounding ?designator (manipulate-environment ?type ?container ?arm ?distance))
    (member ?type (:accessing :sealing))
    (spec:property ?designator (:type ?type))
    (current-entry ?designator :location ?location)
    (current-entry ?location :in ?container)
    (once (or (spec:property ?designator (:arm ?arm))
              (lisp-fun arm-for-furniture ?arm)))
    (entry-or-nil ?designator :distance ?distance))

  (<- (desig:action-grounding ?designator (transport ?object ?search-location ?target ?arm ?accessible))
    (spec:property ?designator (:type :transporting))
    (current-entry ?designator :object ?object)
    (current-entry ?designator :location ?search-location)
    (current-entry ?designator :target ?target)
    (entry-or-nil ?designator :arm ?arm)
    (-> (desig:desig-prop ?search-location (:in ?container))
        (equal ?accessible nil)
        (equal ?accessible t))))
