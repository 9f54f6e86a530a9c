(require cramhy *)
(in-package :kitchen)

(defun beside (place)
  "`place', and the places half a metre to its left and to its right as the robot faces it."
  (let* ((origin (cl-transforms:origin place))
         (robot (btr:pose (btr:get-robot-object)))
         (yaw (cl-transforms:get-yaw (cl-transforms:orientation robot))))
    (loop for step in '(0 0.5 -0.5)
          collect (pose (- (cl-transforms:x origin) (* step (sin yaw)))
                        (+ (cl-transforms:y origin) (* step (cos yaw)))
                        (cl-transforms:z origin)))))

(defun find-thing (type place)
  "Looks at `place' and to both sides of it, until a thing of that type is seen."
  (let ((places (beside place)))
    (with-failure-handling
        ((perception-object-not-found (failure)
           (declare (ignore failure))
           (retry)))
      (unless places
        (fail 'object-nowhere-to-be-found
              :description (format nil "There is no ~(~a~) to be seen." type)))
      (look-at (pop places))
      (detect type))))

(defun take-somehow (thing)
  "Takes a thing that was detected, by one arm and grasp after the other, until one of them reaches it."
  (let ((ways (ways-to-take thing)))
    (with-failure-handling
        ((manipulation-pose-unreachable (failure)
           (declare (ignore failure))
           (pp-plans:park-arms)
           (retry)))
      (unless ways
        (fail 'object-unreachable :object thing
              :description "No arm reaches it by any grasp from here."))
      (destructuring-bind (arm grasp) (pop ways)
        (pick-up thing arm grasp))
      thing)))

(defun where-seen (thing)
  "The pose at which a thing was detected a moment ago."
  (cram-tf:ensure-pose-in-frame (obj-int:get-object-pose thing) "map" :use-zero-time t))

(defun fetch (thing)
  "Goes to a thing that was detected a moment ago, looks again, and takes it. A thing that slips out of the fingers is looked for twice
  more. Where it is out of reach, the robot goes to another place."
  (let* ((?place (where-seen thing))
         (?stand (a location (to-reach ?place))))
    (with-retry-counters ((looks 2))
      (with-failure-handling
          ((gripper-closed-completely (failure)
             (declare (ignore failure))
             (pp-plans:park-arms)
             (do-retry looks
               (retry)))
           ((or navigation-pose-unreachable object-unreachable object-nowhere-to-be-found) (failure)
             (declare (ignore failure))
             (setf ?stand (next-solution ?stand))
             (retry)))
        (unless ?stand
          (fail 'object-unfetchable :object thing
                :description "It was not taken from any place around it."))
        (go-to (reference ?stand))
        (take-somehow (find-thing (desig-prop-value thing :type) ?place))))))

(defun deliver (thing ?place)
  "Puts down at `?place' a thing that the robot holds. Where that is out of reach, the robot goes to another place."
  (let ((?stand (a location (to-reach ?place))))
    (with-failure-handling
        (((or navigation-pose-unreachable manipulation-pose-unreachable) (failure)
           (declare (ignore failure))
           (pp-plans:park-arms)
           (setf ?stand (next-solution ?stand))
           (retry)))
      (unless ?stand
        (fail 'object-undeliverable :object thing
              :description "It could not be put there from any place around."))
      (go-to (reference ?stand))
      (put-down thing ?place))))
