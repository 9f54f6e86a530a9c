;;;; Grasps: the faces of objects that grippers come from, and the poses on the way to an object and away with it.
;;;;
;;;; The faces of an object are :FRONT and :BACK along its x axis, :LEFT-SIDE and :RIGHT-SIDE along y, :TOP and :BOTTOM along z. A robot
;;;; names sides as it sees them: to grasp something from the :FRONT is to grasp the face that is towards the robot.

(in-package #:cram-object-interfaces)

(def-fact-group grasps (object-type-grasp)

  (<- (object-type-grasp ?object-type ?grasp)
    (fail)))

(defun vector->face (vector)
  "The face that a vector in the frame of the object points to."
  (let* ((x (cl-transforms:x vector)) (y (cl-transforms:y vector)) (z (cl-transforms:z vector))
         (greatest (max (abs x) (abs y) (abs z))))
    (cond ((= (abs x) greatest) (if (plusp x) :front :back))
          ((= (abs y) greatest) (if (plusp y) :left-side :right-side))
          (t (if (plusp z) :top :bottom)))))

(defun face->vector (face)
  "A vector in the frame of the object that points to FACE."
  (ecase face
    (:front (cl-transforms:make-3d-vector 1 0 0))
    (:back (cl-transforms:make-3d-vector -1 0 0))
    (:left-side (cl-transforms:make-3d-vector 0 1 0))
    (:right-side (cl-transforms:make-3d-vector 0 -1 0))
    (:top (cl-transforms:make-3d-vector 0 0 1))
    (:bottom (cl-transforms:make-3d-vector 0 0 -1))))

(defun calculate-object-faces (robot-to-object-transform)
  "The face of an object that is towards the robot, and the one that is below, as a list. The robot's z axis points up."
  (let ((place (cl-transforms:translation robot-to-object-transform))
        (back (cl-transforms:q-inv (cl-transforms:rotation robot-to-object-transform))))
    (flet ((face (direction) (vector->face (cl-transforms:rotate back direction))))
      (list (face (cl-transforms:make-3d-vector (- (cl-transforms:x place)) (- (cl-transforms:y place)) 0))
            (face (cl-transforms:make-3d-vector 0 0 -1))))))

(defun front-for-back (face)
  "The object's front is away from a robot that looks along the same axis."
  (case face (:front :back) (:back :front) (t face)))

(defun object-type-grasp->robot-grasp (robot-to-object-transform object-type-grasp)
  "The side, as the robot sees it, that a face of the object is on."
  (front-for-back
   (vector->face (cl-transforms:rotate (cl-transforms:rotation robot-to-object-transform) (face->vector object-type-grasp)))))

(defun robot-grasp->object-type-grasp (robot-to-object-transform robot-grasp)
  "The face of the object that is on a side, as the robot sees it."
  (vector->face (cl-transforms:rotate (cl-transforms:q-inv (cl-transforms:rotation robot-to-object-transform))
                                      (face->vector (front-for-back robot-grasp)))))

(defgeneric get-object-type-grasps (object-type facing-robot-face bottom-face rotationally-symmetric-p arm)
  (:documentation "A lazy list of the grasps of an object that shows one face to the robot and stands on another.")
  (:method (object-type facing-robot-face bottom-face rotationally-symmetric-p arm)
    (declare (ignore facing-robot-face bottom-face rotationally-symmetric-p arm))
    (cut:lazy-mapcar (lambda (solution) (cut:var-value '?grasp solution))
                     (prolog `(object-type-grasp ,object-type ?grasp)))))

(defun upright (transform)
  "TRANSFORM, not turned."
  (cram-tf:copy-transform-stamped transform :rotation (cl-transforms:make-identity-rotation)))

(defun standard-to-particular-gripper (arm)
  "From the standard gripper to that of the robot, whose description tells it; they are the same where it does not."
  (let ((frame (tool-frame arm))
        (transform (or (fact '?transform '(and (cram-robot-interfaces:robot ?robot)
                                           (cram-robot-interfaces:standard-to-particular-gripper-transform ?robot ?transform)))
                       (cl-transforms:make-identity-transform))))
    (cl-transforms-stamped:make-transform-stamped
     frame frame 0.0 (cl-transforms:translation transform) (cl-transforms:rotation transform))))

(defgeneric get-object-grasping-poses (object-name object-type arm grasp object-transform)
  (:documentation "Where the gripper of ARM has to be, in the frame of the robot's base, to take hold of an object: the list of the poses
before the grasp and shortly before it, at the grasp, after lifting and after lifting further.")
  (:method (object-name object-type arm grasp object-transform)
    (let* ((base (cl-transforms-stamped:frame-id object-transform))
           (tool (tool-frame arm))
           (named (cram-tf:copy-transform-stamped
                   (if (prolog `(object-rotationally-symmetric ,object-type)) (upright object-transform) object-transform)
                   :child-frame-id (object-frame object-name)))
           (particular (standard-to-particular-gripper arm))
           (grasp-transform (get-object-type-to-gripper-transform object-type object-name arm grasp)))
      (flet ((pose (object-to-gripper)
               (cram-tf:multiply-transform-stampeds
                base tool (cram-tf:multiply-transform-stampeds base tool named object-to-gripper) particular
                :result-as-pose-or-transform :pose))
             (moved (function) (funcall function object-type object-name arm grasp grasp-transform)))
        (mapcar #'pose (list (moved #'get-object-type-to-gripper-pregrasp-transform)
                             (moved #'get-object-type-to-gripper-2nd-pregrasp-transform)
                             grasp-transform
                             (moved #'get-object-type-to-gripper-lift-transform)
                             (moved #'get-object-type-to-gripper-2nd-lift-transform)))))))
