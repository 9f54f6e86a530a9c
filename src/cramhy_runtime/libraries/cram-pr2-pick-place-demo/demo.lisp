;;;; A world for lessons about picking up and placing: the kitchen, the PR2, and the names of those functions of CRAM's demo that lessons call.
;;;; It is there for those who have no checkout of CRAM; CRAM's own demo, where it is on ROS_PACKAGE_PATH, comes before it.

(defpackage #:cram-pr2-pick-place-demo
  (:nicknames #:pr2-pp-demo #:demo)
  (:use #:common-lisp #:cram-prolog #:desig #:exe))

(in-package #:cram-pr2-pick-place-demo)

(defun init-projection ()
  "Make the world anew: the floor, the kitchen and the robot. `roslisp-utilities:startup-ros' does so."
  (def-fact-group costmap-metadata ()
    (<- (costmap:costmap-size 12 12))
    (<- (costmap:costmap-origin -6 -6))
    (<- (costmap:costmap-resolution 0.05))
    (<- (costmap:costmap-padding 0.3))
    (<- (costmap:costmap-manipulation-padding 0.4))
    (<- (costmap:costmap-in-reach-distance 0.9))
    (<- (costmap:costmap-reach-minimal-distance 0.2))
    (<- (costmap:visibility-costmap-size 2))
    (<- (costmap:orientation-samples 2))
    (<- (costmap:orientation-sample-step 0.1)))
  (cram-occasions-events:clear-belief)
  (setf cram-tf:*tf-default-timeout* 2.0
        prolog:*break-on-lisp-errors* t)
  (btr:add-objects-to-mesh-list "cram_pr2_pick_place_demo"))

(roslisp-utilities:register-ros-init-function init-projection)

(defun initialize ()
  "Make the world as it was in the beginning: nothing is held, no objects are there, the drawers are shut, and the robot stands at its origin."
  (dolist (machine (remove nil (list (btr:get-robot-object) (btr:get-environment-object))))
    (btr:detach-all-objects machine))
  (btr-utils:kill-all-objects)
  (let ((kitchen (btr:get-environment-object)))
    (when kitchen
      (dolist (joint (btr:joint-names kitchen))
        (setf (btr:joint-state kitchen joint) 0.0))))
  (cram-occasions-events:clear-belief)
  (btr:clear-costmap-vis-object))

(defparameter *places-on-counter*
  '((:bowl (1.42 0.8 0.87)) (:cup (1.4 0.55 0.9)) (:milk (1.42 0.3 0.95)) (:breakfast-cereal (1.42 1.05 0.95)) (:spoon (1.4 -0.1 0.87)))
  "Where on the counter by the sink an object of each kind stands before `setting-demo'.")

(defparameter *places-on-island*
  '((:bowl (-0.8 1.2 0.89)) (:cup (-0.8 1.5 0.9)) (:milk (-0.85 1.8 0.945)) (:breakfast-cereal (-0.85 0.7 0.96)) (:spoon (-0.8 1.0 0.865)))
  "Where it is to stand on the island.")

(defun place (object-type places)
  "A location designator of where PLACES has an object of that type."
  (let ((?pose (cl-transforms-stamped:pose->pose-stamped
                "map" 0.0 (btr:ensure-pose (list (second (assoc object-type places)) '(0 0 0 1))))))
    (a location (pose ?pose))))

(cpl:def-cram-function setting-demo (&optional (object-types '(:bowl :spoon :cup :milk :breakfast-cereal)))
  "Set the island: put an object of each type on the counter, and let the robot bring it over. Call it in `urdf-proj:with-simulated-robot'."
  (initialize)
  (dolist (type object-types)
    (btr-utils:spawn-object (intern (format nil "~a-1" type) :keyword) type
                            :pose (list (second (assoc type *places-on-counter*)) '(0 0 0 1))))
  (btr:simulate btr:*current-bullet-world* 20)
  (dolist (?type object-types)
    (let ((?from (place ?type *places-on-counter*))
          (?to (place ?type *places-on-island*)))
      (perform (an action
                   (type transporting)
                   (object (an object (type ?type)))
                   (location ?from)
                   (target ?to))))))
