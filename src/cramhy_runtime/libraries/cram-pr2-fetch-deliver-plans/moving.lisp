;;;; Driving without bumping into anything, and turning to what is to be seen.

(in-package #:cram-pr2-fetch-deliver-plans)

(cpl:def-cram-function go-without-collisions (?navigation-location)
  "Park the arms, find a solution of the location at which the robot touches nothing, and go there."
  (pp-plans:park-arms)
  (pr2-proj-reasoning:check-navigating-collisions ?navigation-location)
  (let ((?free-location (desig:current-desig ?navigation-location)))
    (cpl:with-failure-handling
        ((common-fail:navigation-low-level-failure (failure)
           (roslisp:ros-warn (fd-plans navigate) "~a~%Ignoring." failure)
           (return)))
      (exe:perform (desig:an action (type going) (target ?free-location)))))
  nil)

(defun turned-to (location)
  "The pose of the robot, turned to LOCATION."
  (let* ((here (cram-tf:robot-current-pose :use-current-time-p nil))
         (there (cram-tf:ensure-pose-in-frame (desig:reference location) cram-tf:*fixed-frame* :use-zero-time t))
         (from (cl-transforms:origin here))
         (to (cl-transforms:origin there)))
    (cl-transforms-stamped:copy-pose-stamped
     here :orientation (cl-transforms:axis-angle->quaternion
                        (cl-transforms:make-3d-vector 0 0 1)
                        (atan (- (cl-transforms:y to) (cl-transforms:y from)) (- (cl-transforms:x to) (cl-transforms:x from)))))))

(defun turn-base (location)
  "Turn the base to LOCATION, and the head straight ahead."
  (let ((?pose (turned-to location)))
    (exe:perform (desig:an action (type navigating) (location (desig:a location (pose ?pose)))))
    (exe:perform (desig:an action (type looking) (direction :forward)))))

(cpl:def-cram-function turn-towards (?look-target)
  "Look at a place; if the neck does not turn so far, turn the base once and look again."
  (cpl:with-failure-handling
      (((or desig:designator-error common-fail:navigation-high-level-failure) (failure)
         (failing-as (common-fail:looking-high-level-failure) "~a" failure)))
    (with-other-solutions (1 (fd-plans turn-towards) common-fail:ptu-low-level-failure)
        ((progn (turn-base ?look-target) t)
         (failing-as (common-fail:looking-high-level-failure) "The robot cannot look at ~a from where it is." ?look-target))
      (exe:perform (desig:an action (type looking) (target ?look-target)))))
  nil)
