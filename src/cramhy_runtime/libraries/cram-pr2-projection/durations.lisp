;;;; How long a motion takes in a projection: no time, until a program has facts about it. The modules themselves ask for none of this.

(in-package #:cram-pr2-projection)

(defvar *projection-clock* nil
  "The clock of the projection that runs, nil outside.")

(defparameter *debug-short-sleep-duration* 0.0
  "Seconds to wait after a short motion, for who wants to look on.")

(defparameter *debug-long-sleep-duration* 0.0
  "Seconds to wait after a long motion, for who wants to look on.")

(def-fact-group action-facts (action-duration)
  (<- (action-duration ?action ?seconds)
    (fail)))

(defun action-duration (action &key (default 0))
  "The seconds that ACTION, a designator, takes as the facts of `action-duration' say, else DEFAULT."
  (let ((solution (cut:lazy-car (prolog `(action-duration ,action ?seconds)))))
    (if solution (cut:var-value '?seconds solution) default)))

(defun projection-timestamp-function ()
  "The time of the projection that runs, in seconds; 0 outside."
  (if *projection-clock* (cram-projection:clock-time *projection-clock*) 0))

(defun execute-as-action (motion function)
  "The values of FUNCTION, after whose call the clock of the projection moves on by what MOTION takes."
  (multiple-value-prog1 (funcall function)
    (let ((seconds (action-duration motion)))
      (when (and *projection-clock* (plusp seconds))
        (cram-projection:clock-wait *projection-clock* seconds)))))
