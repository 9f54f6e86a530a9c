;;;; Occasions: what a plan may ask. Nothing is known of them here; a belief state adds its clauses.

(in-package #:cram-plan-occasions-events)

(def-fact-group occasions (object-in-hand object-placed-at object-picked object-put loc looking-at arms-parked)

  (<- (object-in-hand ?object)
    (fail))

  (<- (object-placed-at ?object ?location)
    (fail))

  (<- (object-picked ?object)
    (fail))

  (<- (object-put ?object)
    (fail))

  (<- (loc ?robot-or-object ?location)
    (fail))

  (<- (looking-at ?location)
    (fail))

  (<- (arms-parked)
    (fail)))
