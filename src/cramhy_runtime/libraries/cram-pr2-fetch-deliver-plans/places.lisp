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

(defun container-type (location)
  "The type of the container that LOCATION is in, such as :DRAWER, or nil."
  (let ((container (desig:desig-prop-value location :in)))
    (and container (desig:desig-prop-value (desig:current-desig container) :type))))
