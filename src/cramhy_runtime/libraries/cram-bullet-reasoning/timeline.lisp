;;;; Time: what happened in a world, and how the world was then.

(in-package #:cram-bullet-reasoning)

(defclass event ()
  ((event :initarg :event :initarg :pattern :initform nil :reader event :reader event-pattern)
   (timestamp :initarg :timestamp :initform 0.0 :reader timestamp :reader event-timestamp)
   (world-state :initarg :world-state :initform nil :reader event-world-state))
  (:documentation "What happened, when, and a copy of the world as it was then."))

(defclass timeline ()
  ((events :initarg :events :initform nil :accessor events :reader timeline-events)
   (last-event :initform nil :documentation "The last cons of EVENTS."))
  (:documentation "Events, the first one first."))

(defgeneric last-event (timeline)
  (:documentation "The list whose first element is the last event of TIMELINE, nil when there is none.")
  (:method ((timeline timeline)) (setf (slot-value timeline 'last-event) (last (events timeline)))))

(defun make-event (world pattern &optional (timestamp (current-timestamp)))
  "An event PATTERN, such as (location-change robot), which happened in WORLD."
  (make-instance 'event :pattern pattern :timestamp timestamp :world-state (copy-world world)))

(defun timeline-init (world &optional (time 0.0))
  "A timeline that begins with the event START, with WORLD as it is now."
  (make-instance 'timeline :events (list (make-event world '(start) time))))

(defun timeline-advance (timeline event)
  "Note EVENT; later ones stay behind it. The timeline."
  (setf (events timeline) (merge 'list (events timeline) (list event) #'< :key #'event-timestamp))
  (last-event timeline)
  timeline)

(defun timeline-lookup (timeline stamp)
  "The world as the last event that is not later than STAMP left it, nil when there is none."
  (let ((event (find-if (lambda (event) (<= (event-timestamp event) stamp)) (timeline-events timeline) :from-end t)))
    (and event (event-world-state event))))

(defun timeline-current-world-state (timeline)
  "The world as the last event left it."
  (event-world-state (first (last (timeline-events timeline)))))

(defvar *current-timeline* (timeline-init *current-bullet-world*)
  "Where events of plans are noted.")

(defmacro with-timeline (timeline &body body)
  "Run BODY with TIMELINE as the current one."
  `(let ((*current-timeline* ,timeline)) ,@body))

(defun patterns-and-stamps (timeline)
  "A list (pattern stamp) for each event of TIMELINE."
  (loop for event in (timeline-events timeline)
        collect (list (event-pattern event) (event-timestamp event))))

(defun moments (timeline from until)
  "A list (stamp world) for each state that TIMELINE was in between FROM and UNTIL; the first is that in which it was at FROM."
  (loop for (event next) on (timeline-events timeline)
        for end = (and next (event-timestamp next))
        when (and (< (event-timestamp event) until) (or (null end) (> end from)))
          collect (list (max from (event-timestamp event)) (event-world-state event))))

(def-prolog-handler holds-in-all (bindings ?occasion ?moments)
  (let ((moments (var-value ?moments bindings)))
    (when moments
      (loop with answers = (list bindings)
            for (nil world) in moments
            do (setf answers (loop for answer in answers append (solutions-in world (list ?occasion) answer)))
            finally (return answers)))))

(def-fact-group timeline-predicates (timeline coe:occurs coe:holds)
  (<- (timeline ?timeline)
    (not (bound ?timeline))
    (symbol-value *current-timeline* ?timeline))

  (<- (timeline ?timeline)
    (bound ?timeline)
    (lisp-type ?timeline timeline))

  (<- (coe:occurs ?timeline ?event ?time)
    (timeline ?timeline)
    (lisp-fun patterns-and-stamps ?timeline ?events)
    (member (?event ?time) ?events))

  (<- (coe:occurs ?event (coe:at ?time))
    (coe:occurs ?timeline ?event ?time))

  (<- (coe:occurs ?event (coe:during ?from ?until))
    (bound ?from)
    (bound ?until)
    (coe:occurs ?timeline ?event ?time)
    (<= ?from ?time)
    (< ?time ?until))

  (<- (coe:holds ?timeline ?occasion (coe:at ?time))
    (bound ?time)
    (timeline ?timeline)
    (lisp-fun timeline-lookup ?timeline ?time ?world)
    (lisp-pred identity ?world)
    (with-world ?world ?occasion))

  (<- (coe:holds ?timeline ?occasion (coe:at ?time))
    (not (bound ?time))
    (coe:occurs ?timeline ?event ?time)
    (coe:holds ?timeline ?occasion (coe:at ?time)))

  (<- (coe:holds ?timeline ?occasion (coe:during ?from ?until))
    (bound ?from)
    (bound ?until)
    (timeline ?timeline)
    (lisp-fun moments ?timeline ?from ?until ?moments)
    (member (?time ?world) ?moments)
    (with-world ?world ?occasion))

  (<- (coe:holds ?timeline ?occasion (coe:throughout ?from ?until))
    (bound ?from)
    (bound ?until)
    (timeline ?timeline)
    (lisp-fun moments ?timeline ?from ?until ?moments)
    (holds-in-all ?occasion ?moments))

  (<- (coe:holds ?occasion ?time)
    (bound ?time)
    (coe:holds ?timeline ?occasion ?time)))
