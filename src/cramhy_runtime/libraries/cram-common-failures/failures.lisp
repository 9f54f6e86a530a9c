;;;; What can go wrong while a robot moves, looks and grasps. Low-level failures come from process modules, high-level ones from plans that
;;;; have tried all that they know. A failure is told by its description, one text for each object of the class unless :DESCRIPTION gives
;;;; another; it is shown as it is, so a tilde in it does no harm.

(defpackage #:cram-common-failures
  (:use #:cpl)
  (:nicknames #:common-fail)
  (:export
   #:low-level-failure #:actionlib-action-timed-out
   #:navigation-low-level-failure #:navigation-failure-location #:navigation-pose-unreachable #:navigation-goal-not-reached
   #:perception-low-level-failure #:perception-object-not-found #:object-not-found-object
   #:ptu-low-level-failure #:ptu-goal-unreachable #:ptu-goal-not-reached
   #:manipulation-low-level-failure #:manipulation-goal-not-reached #:manipulation-pose-unreachable
   #:gripper-low-level-failure #:gripper-failure-action #:gripper-closed-completely #:gripper-goal-not-reached
   #:torso-low-level-failure #:torso-goal-unreachable #:torso-goal-not-reached
   #:high-level-failure #:navigation-high-level-failure #:navigation-goal-in-collision #:navigation-failure-pose-stamped
   #:looking-high-level-failure #:manipulation-goal-in-collision #:environment-unreachable #:environment-manipulation-impossible
   #:object-unreachable #:object-unreachable-object #:object-unfetchable #:object-unfetchable-object
   #:object-undeliverable #:object-undeliverable-object #:object-nowhere-to-be-found #:object-nowhere-to-be-found-object))

(in-package #:cram-common-failures)

(defmacro define-failures (&body families)
  "Define failures, each family being (PARENT CLASS...); a CLASS is a name, or (NAME (SLOT INITARG READER))."
  `(progn
     ,@(loop for (parent . classes) in families
             nconc (loop for class in classes
                         collect (destructuring-bind (name &optional slot) (if (listp class) class (list class))
                                   `(define-condition ,name (,parent)
                                      ,(when slot
                                         (destructuring-bind (slot-name initarg reader) slot
                                           `((,slot-name :initarg ,initarg :initform nil :reader ,reader))))))))))

(defun report-description (failure stream)
  (princ (error-description failure) stream))

(define-condition low-level-failure (simple-plan-failure)
  ((description :initarg :description :initform "Low-level failure happened" :reader error-description))
  (:documentation "A process module could not do what it was told.")
  (:report report-description))

(define-condition high-level-failure (simple-plan-failure)
  ((description :initarg :description :initform "High-level failure happened" :reader error-description))
  (:documentation "A plan has tried all that it knows.")
  (:report report-description))

(define-failures
  (low-level-failure
   actionlib-action-timed-out
   (navigation-low-level-failure (location :location navigation-failure-location))
   perception-low-level-failure
   (ptu-low-level-failure (target :location ptu-failure-target))
   manipulation-low-level-failure)
  (navigation-low-level-failure navigation-pose-unreachable navigation-goal-not-reached)
  (perception-low-level-failure (perception-object-not-found (object :object object-not-found-object)))
  (ptu-low-level-failure ptu-goal-unreachable ptu-goal-not-reached)
  (manipulation-low-level-failure
   manipulation-goal-not-reached
   manipulation-pose-unreachable
   (gripper-low-level-failure (action :object gripper-failure-action))
   (torso-low-level-failure (torso :location torso-failure-target)))
  (gripper-low-level-failure gripper-closed-completely gripper-goal-not-reached)
  (torso-low-level-failure torso-goal-unreachable torso-goal-not-reached)
  (high-level-failure
   navigation-high-level-failure
   looking-high-level-failure
   manipulation-goal-in-collision
   environment-unreachable
   environment-manipulation-impossible
   (object-unreachable (object :object object-unreachable-object))
   (object-unfetchable (object :object object-unfetchable-object))
   (object-undeliverable (object :object object-undeliverable-object))
   (object-nowhere-to-be-found (object :object object-nowhere-to-be-found-object)))
  (navigation-high-level-failure
   (navigation-goal-in-collision (pose-stamped :pose-stamped navigation-failure-pose-stamped))))
