;;;; Places from which something works: tried in the world, before the robot goes there.

(in-package #:cram-pr2-projection-reasoning)

(defun next-place (place)
  "The next solution of a location, or nil."
  (handler-case (desig:next-solution place) (desig:designator-error () nil)))

(defun possible-p (function)
  "Whether FUNCTION does not fail."
  (cpl:with-failure-handling
      (((or common-fail:low-level-failure common-fail:high-level-failure) (failure)
         (declare (ignore failure))
         (return nil)))
    (funcall function)
    t))

(defun settle-on-place (location try &key (samples 150) (tries 8))
  "Move LOCATION on to the first of its next solutions at which the robot touches nothing and the function TRY does not fail, with the arms
parked. Returns that location, or nil when none of so many SAMPLES will do, or TRY has failed TRIES times; the world is then as it was."
  (in-simulation
    (in-world-for-now
      (let ((arms (pp-plans::all-arms)))
        (pr2-proj::move-joints (when (member :left arms) (pp-plans::parking-values :left t))
                               (when (member :right arms) (pp-plans::parking-values :right t))))
      (loop repeat samples
            for place = (desig:current-desig location) then (next-place place)
            while (and place (plusp tries))
            do (when (possible-p (lambda () (pr2-proj::drive (desig:reference place))))
                 (when (possible-p try)
                   (return place))
                 (decf tries))))))
