(require cramhy *)
(in-package :kitchen)

(defparameter *distances* '(0.65d0 0.55d0 0.75d0) "how far from a thing the robot stands to reach it, in metres, the best first")

(defun distance-to-robot (place)
  (cl-transforms:v-dist (cl-transforms:origin place)
                        (cl-transforms:origin (btr:pose (btr:get-robot-object)))))

(defun pose-facing (place distance degrees)
  "A pose on the floor: so far from `place', in that direction, and turned towards it."
  (let ((origin (cl-transforms:origin place))
        (angle (radians degrees)))
    (pose (+ (cl-transforms:x origin) (* distance (cos angle)))
          (+ (cl-transforms:y origin) (* distance (sin angle)))
          0
          (+ degrees 180))))

(defun poses-around (place)
  "Poses on circles around `place': of each circle those eight that are nearest to the robot."
  (loop for distance in *distances*
        append (subseq (stable-sort (loop for degrees from 0 below 360 by 20
                                          collect (pose-facing place distance degrees))
                                    #'< :key #'distance-to-robot)
                       0 8)))

(defun generate-poses-to-reach (location)
  "Proposes poses for (a location (to-reach ?place))."
  (let ((place (desig-prop-value location :to-reach)))
    (when place
      (poses-around place))))

(register-location-generator
 5 generate-poses-to-reach
 "Poses around a place, turned towards it.")

(defun touches-nothing-p (pose)
  "Whether the robot, which is tried at that pose in a copy of the world, would touch nothing but what it holds."
  (let* ((copy (btr:copy-world btr:*current-bullet-world*))
         (robot (btr:object copy (btr:get-robot-name))))
    (setf (btr:pose robot) pose)
    (every (lambda (thing)
             (btr:object-attached robot thing))
           (btr:find-objects-in-contact copy robot))))

(defun validate-pose-to-reach (location pose)
  "Rejects poses at which the robot would touch something."
  (cond ((null (desig-prop-value location :to-reach)) :unknown)
        ((touches-nothing-p pose) :accept)
        (t :reject)))

(register-location-validation-function
 5 validate-pose-to-reach
 "Poses at which the robot touches nothing.")
