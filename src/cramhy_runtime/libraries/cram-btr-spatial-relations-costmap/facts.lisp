;;;; The rules that give the costmap of a location.

(in-package #:cram-btr-spatial-relations-costmap)

(defun container-type-p (type)
  (and (prolog `(cram-object-interfaces:object-type-subtype :container ,type)) t))

(def-fact-group spatial-relations-costmap (location-costmap:desig-costmap)

  (<- (thing-at ?designator ?key ?thing)
    (desig:desig-prop ?designator (?key ?object))
    (lisp-type ?object desig:object-designator)
    (lisp-fun thing-of ?object ?thing)
    (lisp-pred identity ?thing))

  (<- (what-for ?designator ?for)
    (once (or (desig:desig-prop ?designator (:for ?for))
              (== ?for nil))))

  ;; A robot stands where no furniture is.
  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (once (or (cram-robot-interfaces:reachability-designator ?designator)
              (cram-robot-interfaces:visibility-designator ?designator)))
    (location-costmap:costmap-padding ?padding)
    (once (location-costmap:costmap ?costmap))
    (location-costmap:costmap-add-function environment-free-space (make-free-space-cost ?padding) ?costmap)
    (location-costmap:costmap-add-height-generator (location-costmap:make-constant-height-function 0.0) ?costmap))

  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (once (thing-at ?designator :on ?thing))
    (what-for ?designator ?for)
    (once (location-costmap:costmap ?costmap))
    (location-costmap:costmap-add-function on-bounding-box (make-surface-cost ?thing ?for) ?costmap)
    (location-costmap:costmap-add-height-generator (make-height-on ?thing ?for) ?costmap))

  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (once (thing-at ?designator :in ?thing))
    (lisp-pred furniture-p ?thing)
    (lisp-fun thing-type ?thing ?type)
    (lisp-pred container-type-p ?type)
    (once (location-costmap:costmap ?costmap))
    (location-costmap:costmap-add-function on-bounding-box (make-box-cost ?thing) ?costmap)
    (location-costmap:costmap-add-height-generator (make-height-in ?thing) ?costmap))

  ;; Sides of furniture, and distances from its middle.
  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (once (or (thing-at ?designator :on ?thing) (thing-at ?designator :in ?thing)))
    (lisp-pred furniture-p ?thing)
    (desig:desig-prop ?designator (:side ?side))
    (member ?side (:left :right :front :back))
    (lisp-fun thing-pose ?thing ?pose)
    (once (location-costmap:costmap ?costmap))
    (location-costmap:costmap-add-function side (make-side-cost ?thing ?side) ?costmap)
    (once (or (and (desig:desig-prop ?designator (:range ?range))
                   (location-costmap:costmap-add-function range (location-costmap:make-range-cost-function ?pose ?range) ?costmap))
              (true)))
    (once (or (and (desig:desig-prop ?designator (:range-invert ?least))
                   (instance-of ring-generator ?name)
                   (location-costmap:costmap-add-function
                    ?name (location-costmap:make-range-cost-function ?pose ?least :invert t) ?costmap))
              (true))))

  ;; Beside things.
  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (member ?relation (:left-of :right-of :in-front-of :behind))
    (thing-at ?designator ?relation ?thing)
    (what-for ?designator ?for)
    (once (location-costmap:costmap ?costmap))
    (location-costmap:costmap-add-function potential-field (make-relation-cost ?thing ?relation) ?costmap)
    (location-costmap:costmap-add-function supporting-object (make-supporter-cost ?thing ?for) ?costmap)
    (location-costmap:costmap-add-height-generator (make-height-beside ?thing ?for) ?costmap))

  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (member ?relation (:near :far-from))
    (thing-at ?designator ?relation ?thing)
    (what-for ?designator ?for)
    (lisp-fun ring ?relation ?thing ?for (?least ?most))
    (lisp-fun thing-pose ?thing ?pose)
    (once (location-costmap:costmap ?costmap))
    (instance-of ring-generator ?outer)
    (location-costmap:costmap-add-function ?outer (location-costmap:make-range-cost-function ?pose ?most) ?costmap)
    (instance-of ring-generator ?inner)
    (location-costmap:costmap-add-function ?inner (location-costmap:make-range-cost-function ?pose ?least :invert t) ?costmap)
    (location-costmap:costmap-add-function near-distribution (location-costmap:make-location-cost-function ?pose 1.0) ?costmap)
    (location-costmap:costmap-add-function supporting-object (make-supporter-cost ?thing ?for) ?costmap)
    (location-costmap:costmap-add-height-generator (make-height-beside ?thing ?for) ?costmap))

  ;; Setting a table.
  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (desig:desig-prop ?designator (:context :table-setting))
    (once (thing-at ?designator :on ?thing))
    (lisp-pred furniture-p ?thing)
    (desig:desig-prop ?designator (:for ?for))
    (desig:desig-prop ?designator (:object-count ?count))
    (once (location-costmap:costmap ?costmap))
    (location-costmap:costmap-add-function slot-generator (make-slots-cost ?thing ?for ?count) ?costmap)))

(def-fact-group object-designators (desig:location-grounding)
  (<- (desig:location-grounding ?designator ?pose)
    (desig:loc-desig? ?designator)
    (desig:current-designator ?designator ?current)
    (desig:desig-prop ?current (:of-item-object ?object))
    (lisp-fun place-of-item ?object ?pose)
    (lisp-pred identity ?pose)))

(defun place-of-item (object)
  "Where an item of the current world is, as a stamped pose in the map."
  (let ((item (btr-belief:get-designator-object (desig:current-desig object))))
    (and item (cl-transforms-stamped:pose->pose-stamped (or cram-tf:*fixed-frame* "map") 0.0 (btr:pose item)))))
