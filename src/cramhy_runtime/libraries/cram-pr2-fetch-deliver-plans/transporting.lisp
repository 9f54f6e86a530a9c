;;;; Opening and closing what objects are in, and transporting.

(in-package #:cram-pr2-fetch-deliver-plans)

(defparameter *pose-at-sink* '((0.7 -0.2 0) (0 0 0 1))
  "Where the robot stands in the room to drop an object at the sink.")

(defparameter *poses-over-sink* '(((0.7 0 1.2) (0 0 0 1)) ((0.65 0 1.0) (0 0 0 1)) ((0.6 0 0.95) (0 0 0 1)))
  "Where it drops it, in the frame of its base: the first that the arm reaches.")

(defun stamped (frame place)
  (let ((pose (btr:ensure-pose place)))
    (cl-transforms-stamped:pose->pose-stamped frame 0.0 pose)))

(cpl:def-cram-function drop-at-sink ()
  "Put what is held over the sink, since it could not be brought to where it was to be."
  (let ((?stand (stamped cram-tf:*fixed-frame* *pose-at-sink*))
        (places *poses-over-sink*))
    (exe:perform (desig:an action (type navigating) (location (desig:a location (pose ?stand)))))
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (failure)
           (when (rest places)
             (roslisp:ros-warn (fd-plans transport) "~a~%Trying lower." failure)
             (pop places)
             (cpl:retry))))
      (let ((?over-sink (stamped cram-tf:*robot-base-frame* (first places))))
        (exe:perform (desig:an action (type placing) (target (desig:a location (pose ?over-sink)))))))
    (pp-plans:park-arms)))

(defun try-to-drop-at-sink ()
  "Drop what is held at the sink, as far as that goes: why the robot drops it is what the caller is to know."
  (cpl:with-failure-handling
      (((or common-fail:low-level-failure common-fail:high-level-failure desig:designator-error) (failure)
         (roslisp:ros-warn (fd-plans transport) "~a~%It was not dropped at the sink." failure)
         (return)))
    (drop-at-sink)))

(defun settle-on-place-to-manipulate-from (location ?type ?container ?arm ?distance)
  "Move LOCATION on to a solution from which the handle of a container can be moved as far as is known."
  (or (pr2-proj-reasoning:settle-on-place
       location (lambda ()
                  (pr2-proj-reasoning:check-environment-manipulation-collisions
                   (desig:an action (type ?type) (arm ?arm) (desig:when ?distance (distance ?distance)) (object ?container)))))
      (cpl:fail 'common-fail:environment-unreachable :description "The handle is out of reach from all of the places ahead.")))

(cpl:def-cram-function manipulate-environment (action-type ?object-to-manipulate ?arm ?distance)
  "Open (ACTION-TYPE is :ACCESSING) or close (:SEALING) a container, from another place each time, ten times at most."
  (pr2-em::handle-of ?object-to-manipulate) ; an error for what is no drawer of the furniture, before anything moves
  (let ((?type (ecase action-type (:accessing :opening) (:sealing :closing)))
        (?stand (place-to-reach-from-container ?object-to-manipulate ?arm)))
    (flet ((give-up (description)
             (cpl:fail 'common-fail:environment-manipulation-impossible :description description)))
      (cpl:with-failure-handling
          ((desig:designator-error (problem)
             (give-up (format nil "~a" problem))))
        (with-other-solutions (10 (fd-plans environment)
                               common-fail:navigation-goal-in-collision
                               common-fail:looking-high-level-failure
                               common-fail:environment-unreachable
                               common-fail:gripper-low-level-failure
                               common-fail:manipulation-low-level-failure)
            ((let ((elsewhere (next-solution ?stand)))
               (when elsewhere (setf ?stand elsewhere)))
             (give-up "The container cannot be moved from any of the places that were tried."))
          (settle-on-place-to-manipulate-from ?stand ?type ?object-to-manipulate ?arm ?distance)
          (exe:perform (desig:an action (type navigating) (location ?stand)))
          (let ((action (desig:an action
                                  (type ?type)
                                  (arm ?arm)
                                  (desig:when ?distance (distance ?distance))
                                  (object ?object-to-manipulate))))
            (pr2-proj-reasoning:check-environment-manipulation-collisions action)
            (exe:perform (desig:current-desig action))
            (pp-plans:park-arms))))))
  nil)

(defun place-to-reach-from-container (?container ?arm)
  (let ((?robot (robot-name)))
    (desig:a location (reachable-for ?robot) (arm ?arm) (object ?container))))

(defun open-or-close (?type ?location ?arm)
  "Open or close the container that a location is in."
  (let ((?distance (when (eq (container-type ?location) :drawer) 0.4)))
    (exe:perform (desig:an action
                           (type ?type)
                           (location ?location)
                           (desig:when ?arm (arm ?arm))
                           (desig:when ?distance (distance ?distance))))))

(defun fetch-and-deliver-once (?object ?target ?arm)
  "Take an object from where it is now, and bring it to ?TARGET."
  (let ((?fetch-from (place-to-reach-from (place-of ?object) ?arm))
        (?deliver-from (place-to-reach-from ?target ?arm))
        (?pick-up (picking-up nil ?object ?arm))
        (?place (placing (when ?arm (desig:an action (type placing) (arm ?arm))) ?object ?target)))
    (pr2-proj-reasoning:with-projected-task-tree (?fetch-from ?deliver-from) 3 #'pr2-proj-reasoning::driving-distance
      (let ((?fetched (exe:perform (desig:an action
                                             (type fetching)
                                             (desig:when ?arm (arm ?arm))
                                             (object ?object)
                                             (robot-location ?fetch-from)
                                             (pick-up-action ?pick-up)))))
        (roslisp:ros-info (fd-plans transport) "Fetched the object.")
        (exe:perform (desig:an action
                               (type delivering)
                               (desig:when ?arm (arm ?arm))
                               (object ?fetched)
                               (target ?target)
                               (robot-location ?deliver-from)
                               (place-action ?place)))))))

(defmacro resolving-or-failing ((object) &body body)
  "Do BODY. What no designator could be resolved for is a failure of fetching OBJECT, or of delivering it when the robot holds it."
  `(cpl:with-failure-handling
       ((desig:designator-error (problem)
          (cpl:fail (if (in-hand-p ,object) 'common-fail:object-undeliverable 'common-fail:object-unfetchable)
                    :object ,object :description (format nil "~a" problem))))
     ,@body))

(defun fetch-and-deliver (?object ?target ?arm)
  "Take an object that was seen, and bring it to ?TARGET. An object that is still held when that fails is dropped at the sink. One that was
put down near to its place is taken again, once."
  (let ((first-failure nil))
    (cpl:with-retry-counters ((left 1))
      (cpl:with-failure-handling
          ((common-fail:object-undeliverable (failure)
             (cond ((in-hand-p ?object)
                    (roslisp:ros-warn (fd-plans transport) "~a~%Dropping the object at the sink." failure)
                    (try-to-drop-at-sink))
                   ((worth-taking-again-p ?object ?target)
                    (cpl:do-retry left
                      (roslisp:ros-warn (fd-plans transport) "~a~%Taking the object again." failure)
                      (setf first-failure failure)
                      (cpl:retry)))))
           (common-fail:object-unfetchable (failure)
             (when first-failure
               (roslisp:ros-warn (fd-plans transport) "~a" failure)
               (cpl:fail first-failure))))
        (resolving-or-failing (?object)
          (fetch-and-deliver-once ?object ?target ?arm))))))

(cpl:def-cram-function transport (?object-designator ?search-location ?delivering-location ?arm search-location-accessible)
  "Find an object, take it, and bring it to another place. What it is in is opened before, and closed again whatever happens. An object
that is held and cannot be brought to its place is dropped at the sink, and the failure goes on to the caller."
  (unless search-location-accessible
    (open-or-close :accessing ?search-location ?arm))
  (unwind-protect
       (let ((object (exe:perform (desig:an action (type searching) (object ?object-designator) (location ?search-location)))))
         (roslisp:ros-info (fd-plans transport) "Found the object ~a." (desig:desig-prop-value object :name))
         (fetch-and-deliver object ?delivering-location ?arm))
    (unless search-location-accessible
      (open-or-close :sealing ?search-location ?arm)))
  nil)
