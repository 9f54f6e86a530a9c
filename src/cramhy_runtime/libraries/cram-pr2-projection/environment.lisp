;;;; The environment in which plans run on the robot of the current world.

(in-package #:cram-pr2-projection)

(defun new-transformer ()
  "A transformer that knows where the frames of the robot are."
  (unless (and cram-tf:*fixed-frame* cram-tf:*robot-base-frame*)
    (cram-tf::set-frames))
  (let ((transformer (make-instance 'cl-tf:transformer)))
    (btr-belief:set-tf-from-bullet :transformer transformer)
    transformer))

(defvar *last-timeline* nil
  "What happened in the last projection: see `btr:timeline-lookup'.")

(cram-projection:define-projection-environment pr2-bullet-projection-environment
  :special-variable-initializers
  ((cram-tf:*transformer* (new-transformer))
   (btr:*current-timeline* (btr:timeline-init btr:*current-bullet-world*))
   (desig:*default-role* 'projection-role)
   (*projection-clock* (make-instance 'cram-projection:partially-ordered-clock)))
  :process-module-definitions
  (pr2-proj-navigation pr2-proj-torso pr2-proj-ptu pr2-proj-perception pr2-proj-grippers pr2-proj-arms)
  :shutdown (setf *last-timeline* btr:*current-timeline*))

(defmethod cram-occasions-events:on-event update-tf ((event cpoe:robot-state-changed))
  (when (eq cram-projection:*projection-environment* 'pr2-bullet-projection-environment)
    (btr-belief:set-tf-from-bullet)))

(defmacro with-simulated-robot (&body body)
  "Run BODY as a plan of the robot in the current world; the first value of BODY."
  `(let ((result (cram-projection:with-projection-environment pr2-bullet-projection-environment
                   (cpl:top-level ,@body))))
     (first (slot-value result 'cram-projection::result))))

(defmacro with-projected-robot (&body body)
  "As `with-simulated-robot'."
  `(with-simulated-robot ,@body))
