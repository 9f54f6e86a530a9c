(in-package :barista-plans)

(defclass cup-event (event)
  ((arm :initarg :arm :reader event-arm)
   (object :initarg :object :reader event-object)))

(defclass cup-taken (cup-event) ())
(defclass cup-put (cup-event) ())

(defmethod on-event trace-cups ((event cup-event))
  (report "event ~(~a~) ~(~a~)" (type-of event) (thing-name (event-object event))))

(defmethod on-event weigh-cups ((event cup-taken))
  (report "~d g" (round (* 1000 (bk:weigh (event-object event))))))

(def-fact-group barista-occasions (holds)
  (<- (holds (cup-held ?arm ?name))
    (lisp-fun held-pairs ?pairs)
    (member (?arm ?name) ?pairs))
  (<- (holds (robot-at ?x ?y))
    (lisp-fun robot-place (?x ?y))))

(defun held-pairs () (loop for (arm . thing) in (value *held*) collect (list arm (thing-name thing))))
(defun robot-place ()
  (subseq (mapcar #'round (btf:pose->list (cl-transforms:origin (value *robot-pose*)))) 0 2))
