;;;; What plans tell the belief state (events) and what they ask it (occasions).

(defpackage #:cram-plan-occasions-events
  (:use #:common-lisp #:cram-occasions-events #:cram-prolog)
  (:nicknames #:cpoe)
  (:shadowing-import-from #:cram-occasions-events #:event)
  (:export
   ;; events
   #:object-perceived-event #:object-updated-event #:object-removed-event #:robot-state-changed
   #:object-connection-event #:object-attached #:object-detached #:object-articulation-event
   #:environment-manipulation-event #:container-opening-event #:container-closing-event
   #:event-object-designator #:perception-source #:event-object-name #:event-arm #:opening-distance
   #:environment-event-joint-name #:environment-event-arm #:environment-event-object #:environment-event-distance
   #:event-object #:link #:event-link #:side #:event-side #:object #:object-designator #:container-handle-grasping-event
   ;; occasions
   #:object-in-hand #:object-placed-at #:object-picked #:object-put #:loc #:looking-at #:arms-parked))
