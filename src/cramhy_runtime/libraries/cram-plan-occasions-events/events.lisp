;;;; Events: what a plan did or saw.

(in-package #:cram-plan-occasions-events)

(defmacro define-event (name parent documentation &rest slots)
  "Define the class NAME of events. Each of SLOTS is (SLOT READER WHAT), where WHAT, such as \"an object\", is said to be missing when the
slot is not given, or (SLOT READER :DEFAULT VALUE). A slot (SLOT INITARG) has another keyword than its name."
  `(defclass ,name (,parent)
     ,(loop for (slot reader what default) in slots
            collect `(,(if (listp slot) (first slot) slot)
                            :initarg ,(if (listp slot) (second slot) (intern (symbol-name slot) :keyword))
                            :reader ,reader
                            :initform ,(if (eq what :default) default `(error "~A requires ~A." ',name ,what))))
     (:documentation ,documentation)))

(define-event object-perceived-event event
  "An object was seen."
  (object-designator event-object-designator "an object")
  (perception-source perception-source "a perception source"))

(define-event object-updated-event object-perceived-event
  "More is known of an object.")

(define-event object-removed-event event
  "An object is gone."
  (object-name event-object-name :default :object-name))

(define-event robot-state-changed event
  "The robot has moved.")

(define-event object-connection-event event
  "A hand and an object were joined or parted."
  (object-name event-object-name "an object name")
  (arm event-arm "an arm"))

(define-event object-attached object-connection-event
  "A hand holds an object.")

(define-event object-detached object-connection-event
  "A hand has let an object go.")

(define-event object-articulation-event event
  "An object that has a joint was opened so far."
  (object-designator event-object-designator "an object")
  (opening-distance opening-distance "an opening distance"))

(define-event environment-manipulation-event event
  "A joint of the furniture was moved by so many metres."
  (joint-name environment-event-joint-name "a joint name")
  ((arm :side) environment-event-arm "a side")
  ((object :environment) environment-event-object "an environment")
  (distance environment-event-distance "a distance"))

(define-event container-opening-event environment-manipulation-event
  "A drawer or door was opened.")

(define-event container-closing-event environment-manipulation-event
  "A drawer or door was closed.")
