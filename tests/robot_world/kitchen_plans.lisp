;;;; Plans as readers of CRAM's kitchen tutorials write them: bare motions, actions, handlers of failures. Written from bullet-world.md.

(dolist (system '(:roslisp-utilities :cl-transforms :cl-transforms-stamped :cl-tf :cram-tf :cram-language :cram-executive :cram-designators
                  :cram-prolog :cram-projection :cram-occasions-events :cram-common-failures :cram-physics-utils :cl-bullet
                  :cram-bullet-reasoning :cram-bullet-reasoning-belief-state :cram-bullet-reasoning-utilities :cram-location-costmap
                  :cram-btr-visibility-costmap :cram-robot-pose-gaussian-costmap :cram-occupancy-grid-costmap
                  :cram-btr-spatial-relations-costmap :cram-pr2-projection :cram-mobile-pick-place-plans :cram-pr2-description
                  :cram-knowrob-pick-place :cram-utilities))
  (asdf:load-system system))

(defpackage :kitchen-plans
  (:use :common-lisp :cram-prolog :desig :exe :cram-pr2-projection :cram-common-failures))

(in-package :kitchen-plans)

(defun init-projection ()
  (def-fact-group costmap-metadata (costmap:costmap-size costmap:costmap-origin costmap:costmap-resolution costmap:costmap-padding
                                    costmap:costmap-manipulation-padding costmap:costmap-in-reach-distance
                                    costmap:costmap-reach-minimal-distance)
    (<- (costmap:costmap-size 12 12))
    (<- (costmap:costmap-origin -6 -6))
    (<- (costmap:costmap-resolution 0.05))
    (<- (costmap:costmap-padding 0.2))
    (<- (costmap:costmap-manipulation-padding 0.2))
    (<- (costmap:costmap-in-reach-distance 0.6))
    (<- (costmap:costmap-reach-minimal-distance 0.2)))
  (setf btr-belief:*robot-parameter* "robot_description"
        btr-belief:*kitchen-parameter* "kitchen_description")
  (coe:clear-belief)
  (setf cram-tf:*tf-default-timeout* 2.0
        prolog:*break-on-lisp-errors* t))

(roslisp-utilities:register-ros-init-function init-projection)

(defun pose (frame place &optional (turn '(0 0 0 1)))
  (cl-transforms-stamped:make-pose-stamped frame 0.0 (apply #'cl-transforms:make-3d-vector place)
                                           (apply #'cl-transforms:make-quaternion turn)))

(defparameter *counter* (pose "map" '(-1.8547d0 -0.381d0 0) '(0 0 -0.70710678d0 0.70710678d0)))
(defparameter *near-table* (pose "map" '(-1.447d0 -0.15d0 0) '(0 0 -0.70710678d0 0.70710678d0)))
(defparameter *island* (pose "map" '(-0.15d0 2.0d0 0) '(0 0 -1 0)))
(defparameter *on-table* (pose "map" '(-2 -0.9d0 0.86d0)))
(defparameter *on-island* (pose "map" '(-0.8d0 2 0.9d0)))
(defparameter *ahead* (pose "base_footprint" '(0.65335d0 0.076d0 0.758d0)))
(defparameter *left-ahead* (pose "base_footprint" '(0.65335d0 0.76d0 0.758d0)))
(defparameter *right-ahead* (pose "base_footprint" '(0.65335d0 -0.76d0 0.758d0)))

(defun spawn (name place &optional (color '(1 0 0)))
  (prolog `(and (btr:bullet-world ?world)
                (assert (btr:object ?world :mesh ,name ,place :mass 0.2 :color ,color :mesh :bottle))
                (btr:simulate ?world 100))))

;;; Bare motions.

(defun go-to (?pose)
  (perform (a motion (type going) (target (a location (pose ?pose))))))

(defun look-down ()
  (let ((?pose *ahead*))
    (perform (a motion (type looking) (target (a location (pose ?pose)))))))

(defun see-bottle ()
  (perform (a motion (type detecting) (object (an object (type bottle))))))

(defun get-ready (?pose)
  (cpl:par
    (go-to ?pose)
    (perform (a motion (type moving-torso) (joint-angle 0.3)))
    (pp-plans::park-arms)))

(defun take (?object ?arm)
  (perform (an action (type picking-up) (arm ?arm) (object ?object)))
  (pp-plans::park-arms :arm ?arm))

(defun put-at (?pose ?arm)
  (perform (an action (type placing) (arm ?arm) (target (a location (pose ?pose)))))
  (pp-plans::park-arms :arm ?arm))

(defun switch-two-bottles ()
  (spawn 'bottle-1 '((-2 -0.9 0.86) (0 0 0 1)))
  (spawn 'bottle-2 '((-0.8 2 0.9) (0 0 0 1)) '(0 1 0))
  (proj:with-projection-environment pr2-proj:pr2-bullet-projection-environment
    (cpl:top-level
      (get-ready *counter*)
      (look-down)
      (take (see-bottle) :right)
      (go-to *island*)
      (take (see-bottle) :left)
      (put-at *on-island* :right)
      (go-to *counter*)
      (put-at *on-table* :left)
      (pp-plans::park-arms))))

;;; Actions, and what to do when one fails.

(defmacro handle-failure (errors program-body &body error-handler-body)
  "Do the forms of PROGRAM-BODY; on a failure of ERRORS those of the handler, which may retry."
  `(cpl:with-failure-handling
       ((,errors (failure)
          (format t "~%Failure happened: ~a~%" failure)
          ,@error-handler-body))
     ,@program-body))

(defun look (?pose)
  (perform (an action (type looking) (target (a location (pose ?pose))))))

(defun find-object (?type)
  "Turn the head until an object of that type is seen."
  (let ((directions (list *ahead* *right-ahead* *left-ahead*)))
    (look (pop directions))
    (handle-failure perception-object-not-found
        ((perform (an action (type detecting) (object (an object (type ?type))))))
      (when directions
        (perform (an action (type looking) (direction :forward)))
        (look (pop directions))
        (cpl:retry))
      (cpl:fail 'object-nowhere-to-be-found :description "No such object was found."))))

(defun pick-up-somehow (?object)
  "Try both arms and all grasps that are known."
  (let ((ways (loop for arm in '(:left :right)
                    append (loop for grasp in (cut:force-ll (obj-int::get-object-type-grasps :bottle nil nil nil arm))
                                 collect (list arm grasp)))))
    (handle-failure (or manipulation-pose-unreachable gripper-closed-completely)
        ((destructuring-bind (?arm ?grasp) (first ways)
           (perform (an action (type picking-up) (arm ?arm) (grasp ?grasp) (object ?object)))
           (pp-plans:park-arms :arm ?arm)
           ?arm))
      (pp-plans:park-arms)
      (pop ways)
      (when ways
        (cpl:retry))
      (cpl:fail 'object-unfetchable :object ?object :description "No way to take it was found."))))

(defun move-bottle (place)
  (spawn 'bottle-1 place)
  (with-simulated-robot
    (let ((?stand *near-table*) (?there *island*) (?target *on-island*))
      (cpl:par
        (perform (an action (type going) (target (a location (pose ?stand)))))
        (perform (a motion (type moving-torso) (joint-angle 0.3)))
        (pp-plans:park-arms))
      (let* ((?bottle (find-object :bottle))
             (?arm (pick-up-somehow ?bottle)))
        (perform (an action (type going) (target (a location (pose ?there)))))
        (perform (an action (type placing) (arm ?arm) (object ?bottle) (target (a location (pose ?target)))))
        (pp-plans:park-arms :arm ?arm)
        ?arm))))

(defun place-of (name)
  (let ((place (cl-transforms:origin (btr:pose (btr:object btr:*current-bullet-world* name)))))
    (mapcar (lambda (number) (/ (round number 0.01) 100.0)) (list (cl-transforms:x place) (cl-transforms:y place) (cl-transforms:z place)))))

(defun held ()
  (mapcar #'first (btr:attached-objects (btr:get-robot-object))))
