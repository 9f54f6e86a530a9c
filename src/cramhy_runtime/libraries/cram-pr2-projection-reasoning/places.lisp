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

(defun park-for-now ()
  "Put the arms where they are while the robot drives."
  (let ((arms (pp-plans::all-arms)))
    (pr2-proj::move-joints (when (member :left arms) (pp-plans::parking-values :left t))
                           (when (member :right arms) (pp-plans::parking-values :right t)))))

(defun possible-here-p (try)
  "Whether the function TRY does not fail from where the robot is, with the arms parked; the world is then as it was."
  (in-simulation
    (in-world-for-now
      (park-for-now)
      (possible-p try))))

(defun first-free-pose (poses)
  "The first of POSES in the room at which the robot touches nothing, with the arms parked and the torso up, or nil."
  (in-simulation
    (in-world-for-now
      (park-for-now)
      (pr2-proj::move-torso (highest-torso))
      (find-if (lambda (pose) (possible-p (lambda () (pr2-proj::drive pose)))) poses))))

(defun first-possible-pose (poses try &optional (tries 16))
  "The first of POSES in the room at which the robot touches nothing, and the function TRY does not fail, with the arms parked; nil when there
is none, or TRY has failed TRIES times. The world is then as it was."
  (in-simulation
    (in-world-for-now
      (park-for-now)
      (dolist (pose poses)
        (when (possible-p (lambda () (pr2-proj::drive pose)))
          (when (possible-p try) (return pose))
          (when (zerop (decf tries)) (return nil)))))))

(defun highest-torso ()
  "The upper limit of the joint of the torso, metres."
  (cram-robot-interfaces:get-joint-upper-limit
   (pr2-proj::value '?joint `(cram-robot-interfaces:robot-torso-link-joint ,(btr:get-robot-name) ?link ?joint))))

(defun same-place-p (pose other)
  "Whether two poses in the room are less than a centimetre and a degree apart."
  (and (< (cl-transforms:v-dist (cl-transforms:origin pose) (cl-transforms:origin other)) 0.01)
       (< (cl-transforms:angle-between-quaternions (cl-transforms:orientation pose) (cl-transforms:orientation other)) 0.017)))

(defun settle-on-place (location try &key (samples 150) (tries 8))
  "Move LOCATION on to the first of its next solutions at which the robot touches nothing and the function TRY does not fail, with the arms
parked. Returns that location, or nil when none of so many SAMPLES will do, or TRY has failed TRIES times, no place being tried twice; the
world is then as it was."
  (in-simulation
    (in-world-for-now
      (park-for-now)
      (let ((tried ()))
        (loop repeat samples
              for place = (desig:current-desig location) then (next-place place)
              while (and place (< (length tried) tries))
              do (let ((pose (desig:reference place)))
                   (when (and (not (member pose tried :test #'same-place-p))
                              (possible-p (lambda () (pr2-proj::drive pose))))
                     (when (possible-p try)
                       (return place))
                     (push pose tried))))))))
