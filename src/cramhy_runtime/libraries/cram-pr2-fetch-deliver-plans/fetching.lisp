;;;; Fetching.

(in-package #:cram-pr2-fetch-deliver-plans)

(defun see-again (?object)
  "Look at an object from where the robot is now, and detect it. Returns what was seen."
  (let ((?place (place-of ?object))
        (?current (desig:current-desig ?object)))
    (exe:perform (desig:an action (type turning-towards) (target ?place)))
    (exe:perform (desig:an action (type detecting) (object ?current)))))

(defun picking-up (pick-up-action ?object ?arm)
  "The action of picking up an object as it was seen now, by the arm and grasp of PICK-UP-ACTION where that has any."
  (let ((?arm (or (and pick-up-action (desig:desig-prop-value pick-up-action :arm)) ?arm))
        (?grasp (and pick-up-action (desig:desig-prop-value pick-up-action :grasp))))
    (desig:an action
              (type picking-up)
              (desig:when ?arm (arm ?arm))
              (desig:when ?grasp (grasp ?grasp))
              (object ?object))))

(defun pick-up-what-is-seen (object arm pick-up-action)
  "See an object once more, find out how to take it, and take it."
  (let ((action (picking-up pick-up-action (see-again object) arm)))
    (pr2-proj-reasoning:check-picking-up-collisions action)
    (exe:perform (desig:current-desig action))))

;;; Before the robot goes anywhere, the plan tries in the world whether the object can be seen and taken from there.

(defun look-ahead-to (pose)
  "Look at a pose, for a try."
  (pr2-proj::look-at :pose pose))

(defun try-picking-up (name object arm pick-up-action)
  "Fail unless the item of that NAME, which OBJECT means, is seen and can be taken from where the robot is."
  (let* ((object (desig:current-desig object))
         (item (btr:object btr:*current-bullet-world* name)))
    (look-ahead-to (pose-in-room object))
    (unless (member item (pr2-proj::visible-items object))
      (cpl:fail 'common-fail:perception-object-not-found :object object :description "The object is not seen from there."))
    (pr2-proj-reasoning:check-picking-up-collisions
     (picking-up pick-up-action (pr2-proj::seen-object object item) arm))))

(defun in-container-p (object)
  "Whether OBJECT was sought in something."
  (let ((location (desig:desig-prop-value object :location)))
    (and location (desig:desig-prop-value location :in) t)))

(defun place-of-robot ()
  "A location designator of where the robot is."
  (let ((?pose (cl-transforms-stamped:pose->pose-stamped cram-tf:*fixed-frame* 0.0 (btr:pose (btr:get-robot-object)))))
    (desig:a location (pose ?pose))))

(defun place-to-fetch-from (location object arm pick-up-action)
  "From where OBJECT can be taken as far as is known: the next such solution of LOCATION, or the place where the robot is. What lies in a
container, and is seen only from few places, is taken from the place from which it was seen, if that goes."
  (let ((item (btr-belief:get-designator-object (desig:current-desig object))))
    (flet ((try ()
             (try-picking-up (btr:name item) object arm pick-up-action)))
      (cond ((null item) location)
            ((and (in-container-p object) (pr2-proj-reasoning::possible-here-p #'try)) (place-of-robot))
            ((pr2-proj-reasoning:settle-on-place location #'try))
            ((pr2-proj-reasoning::possible-here-p #'try) (place-of-robot))
            (t (cpl:fail 'common-fail:object-unreachable
                         :object object :description "The object cannot be taken from any of the places ahead."))))))

(defun in-hand-p (object)
  "Whether the robot holds OBJECT; true where no world knows it."
  (let ((item (btr-belief:get-designator-object (desig:current-desig object))))
    (or (null item)
        (and (btr:object-attached (btr:get-robot-object) item) t))))

(cpl:def-cram-function fetch (?object-designator ?arm ?pick-up-robot-location pick-up-action)
  "Go to an object, take it, and park the arms. Where it is out of reach, the robot goes to another place, ten times; where the fingers miss
it, the robot looks again, once. Returns the object as it is known then."
  (flet ((give-up (&optional (description "The object was not taken from any of the places that were tried."))
           (cpl:fail 'common-fail:object-unfetchable :object ?object-designator :description description)))
    (cpl:with-failure-handling
        ((desig:designator-error (problem)
           (roslisp:ros-warn (fd-plans fetch) "~a" problem)
           (give-up "The place to fetch the object from could not be resolved.")))
      (with-other-solutions (10 (fd-plans fetch)
                             common-fail:navigation-goal-in-collision
                             common-fail:looking-high-level-failure
                             common-fail:perception-low-level-failure
                             common-fail:object-unreachable
                             common-fail:manipulation-low-level-failure)
          ((let ((elsewhere (next-solution ?pick-up-robot-location)))
             (when elsewhere (setf ?pick-up-robot-location elsewhere)))
           (give-up))
        (let ((?place (place-to-fetch-from ?pick-up-robot-location ?object-designator ?arm pick-up-action)))
          (exe:perform (desig:an action (type navigating) (location ?place))))
        (with-other-solutions (1 (fd-plans fetch) common-fail:gripper-low-level-failure)
            ((progn (pp-plans:park-arms) t)
             (cpl:fail 'common-fail:object-unreachable :object ?object-designator :description "The fingers closed beside the object."))
          (pick-up-what-is-seen ?object-designator ?arm pick-up-action)
          (pp-plans:park-arms)
          (unless (in-hand-p ?object-designator)
            (cpl:fail 'common-fail:gripper-closed-completely :description "The object slipped out of the hand."))))))
  (desig:current-desig ?object-designator))
