;;;; Where things are, and from where the robot sees or reaches them.

(in-package #:cram-pr2-fetch-deliver-plans)

(defun robot-name ()
  "The name of the robot whose description is loaded."
  (or (cram-robot-interfaces:current-robot-symbol)
      (error "ROBOT was not defined. Have you loaded a robot package?")))

(defun pose-in-room (object)
  "Where an object is in the room: as the belief state has it now, else as it was seen."
  (let* ((object (desig:current-desig object))
         (believed (btr-belief:get-designator-object object)))
    (if believed
        (cl-transforms-stamped:pose->pose-stamped cram-tf:*fixed-frame* 0.0 (btr:pose believed))
        (let ((seen (obj-int:get-object-pose object)))
          (when seen
            (cram-tf:ensure-pose-in-frame seen cram-tf:*fixed-frame* :use-zero-time t))))))

(defun place-of (object)
  "A location designator of where an object is."
  (let ((?pose (or (pose-in-room object)
                   (failing-as (common-fail:object-nowhere-to-be-found :object object) "It is not known where ~a is." object))))
    (desig:a location (pose ?pose))))

(defun place-to-see-from (?location)
  "A location designator of places from which the robot sees ?LOCATION."
  (let ((?robot (robot-name)))
    (desig:a location (visible-for ?robot) (location ?location))))

(defun place-to-reach-from (?location ?arm)
  "A location designator of places from which the robot reaches ?LOCATION; ?ARM may be nil."
  (let ((?robot (robot-name)))
    (desig:a location (reachable-for ?robot) (desig:when ?arm (arm ?arm)) (location ?location))))

(defparameter *distances-around* '(0.65 0.6 0.7 0.55 0.75 0.5 0.8 0.45 0.85)
  "How far from a thing a simulated robot stands to reach it where the costmaps of the application give no place that serves, metres.")

(defun poses-around (pose)
  "Poses of the robot, on the floor and turned towards POSE, those with the best distance first, and of these the ones nearest to the robot."
  (let* ((there (cl-transforms:origin pose))
         (here (cl-transforms:origin (btr:pose (btr:get-robot-object)))))
    (flet ((at (distance turn)
             (let ((way (cl-transforms:make-3d-vector (* distance (cos turn)) (* distance (sin turn)) 0)))
               (cl-transforms-stamped:make-pose-stamped
                cram-tf:*fixed-frame* 0.0
                (cl-transforms:copy-3d-vector (cl-transforms:v- there way) :z 0.0d0)
                (cl-transforms:axis-angle->quaternion (cl-transforms:make-3d-vector 0 0 1) turn))))
           (way-to (pose)
             (cl-transforms:v-dist here (cl-transforms:origin pose))))
      (loop for distance in *distances-around*
            append (sort (loop for turn below 24 collect (at distance (* turn (/ pi 12)))) #'< :key #'way-to)))))

(defun free-place-around (pose try &optional first)
  "A location of the first pose around POSE at which the robot touches nothing and the function TRY does not fail, whatever the costmaps say;
the pose FIRST is tried before the others. Nil where there is none, and for a real robot, which stays within the costmaps."
  (when (pr2-proj-reasoning::simulated-p)
    (let ((?pose (pr2-proj-reasoning::first-possible-pose (append (when first (list first)) (poses-around pose)) try)))
      (when ?pose
        (roslisp:ros-warn (fd-plans places) "No place of the costmaps serves. The simulated robot takes another free place: ~a" ?pose)
        (desig:a location (pose ?pose))))))

(defun container-type (location)
  "The type of the container that LOCATION is in, such as :DRAWER, or nil."
  (let ((container (desig:desig-prop-value location :in)))
    (and container (desig:desig-prop-value (desig:current-desig container) :type))))
