;;;; Places from which something works: tried in the world, before the robot goes there.

(in-package #:cram-pr2-projection-reasoning)

(defun settle-on-place (location try &optional (samples 30))
  "Move LOCATION on to the first of its next solutions at which the robot touches nothing and the function TRY does not fail, with the arms
parked. Returns that location, or nil when none of so many SAMPLES will do; the world is then as it was."
  (in-simulation
    (in-world-for-now
      (pp-plans:park-arms)
      (loop repeat samples
            for place = (desig:current-desig location)
              then (handler-case (desig:next-solution place) (desig:designator-error () nil))
            while place
            do (cpl:with-failure-handling
                   (((or common-fail:low-level-failure common-fail:high-level-failure) (failure)
                      (declare (ignore failure))
                      (return nil)))
                 (pr2-proj::drive (desig:reference place))
                 (funcall try)
                 (return-from settle-on-place place))))))
