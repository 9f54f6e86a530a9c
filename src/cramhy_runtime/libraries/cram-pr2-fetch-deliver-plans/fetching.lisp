;;;; Fetching.

(in-package #:cram-pr2-fetch-deliver-plans)

(defun as-remembered (object)
  "OBJECT, which was seen, as if it were seen from where the robot is now: it lies where it lay. Nil where no world knows it."
  (let ((item (btr-belief:get-designator-object object)))
    (and item (pr2-proj::seen-object object item))))

(defun see-again (?object may-be-hidden)
  "Look at an object from where the robot is now, and detect it. Returns what was seen; with MAY-BE-HIDDEN, what the robot knows of an object
that it does not see now."
  (let ((?place (place-of ?object))
        (?current (desig:current-desig ?object)))
    (exe:perform (desig:an action (type turning-towards) (target ?place)))
    (cpl:with-failure-handling
        ((common-fail:perception-low-level-failure (failure)
           (let ((remembered (and may-be-hidden (as-remembered ?current))))
             (when remembered
               (roslisp:ros-warn (fd-plans fetch) "~a~%Taking it from where it was seen." failure)
               (return remembered)))))
      (exe:perform (desig:an action (type detecting) (object ?current))))))

(defun picking-up (pick-up-action ?object ?arm)
  "The action of picking up an object as it was seen now, by the arm and grasp of PICK-UP-ACTION where that has any."
  (let ((?arm (or (and pick-up-action (desig:desig-prop-value pick-up-action :arm)) ?arm))
        (?grasp (and pick-up-action (desig:desig-prop-value pick-up-action :grasp))))
    (desig:an action
              (type picking-up)
              (desig:when ?arm (arm ?arm))
              (desig:when ?grasp (grasp ?grasp))
              (object ?object))))

(defun pick-up-what-is-seen (object arm pick-up-action may-be-hidden)
  "See an object once more, find out how to take it, and take it."
  (let ((action (picking-up pick-up-action (see-again object may-be-hidden) arm)))
    (pr2-proj-reasoning:check-picking-up-collisions action)
    (exe:perform (desig:current-desig action))))

;;; Before the robot goes anywhere, the plan tries in the world whether the object can be seen and taken from there.

(defun look-ahead-to (pose)
  "Look at a pose, for a try."
  (pr2-proj::look-at :pose pose))

(defun try-picking-up (name object arm pick-up-action &optional may-be-hidden)
  "Fail unless the item of that NAME, which OBJECT means, is seen, or MAY-BE-HIDDEN, and can be taken from where the robot is."
  (let* ((object (desig:current-desig object))
         (item (btr:object btr:*current-bullet-world* name)))
    (look-ahead-to (pose-in-room object))
    (unless (or may-be-hidden (member item (pr2-proj::visible-items object)))
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
  "From where OBJECT can be taken as far as is known: the next such solution of LOCATION, or the place where the robot is; nil where there is
none. What lies in a container, and is seen only from few places, is taken from the place from which it was seen, if that goes."
  (let ((item (btr-belief:get-designator-object (desig:current-desig object))))
    (flet ((try ()
             (try-picking-up (btr:name item) object arm pick-up-action)))
      (cond ((null item) location)
            ((and (in-container-p object) (pr2-proj-reasoning::possible-here-p #'try)) (place-of-robot))
            ((pr2-proj-reasoning:settle-on-place location #'try))
            ((pr2-proj-reasoning::possible-here-p #'try) (place-of-robot))
            (t (roslisp:ros-warn (fd-plans fetch) "The object cannot be taken from any of the places ahead."))))))

(defun top-grasp-p (object)
  "Whether it is known how a hand comes from above to take things of the type of OBJECT; for some types no fact offers that."
  (let ((type (desig:desig-prop-value (desig:current-desig object) :type)))
    (ignore-errors (and (obj-int:get-object-type-to-gripper-transform type nil :left :top) t))))

(defun from-above (object pick-up-action)
  "PICK-UP-ACTION, but with a hand that comes from above, which others beside OBJECT do not hinder."
  (let ((?arm (and pick-up-action (desig:desig-prop-value pick-up-action :arm)))
        (?object (desig:current-desig object)))
    (desig:an action (type picking-up) (desig:when ?arm (arm ?arm)) (grasp :top) (object ?object))))

(defun other-way-to-fetch (location object arm pick-up-action)
  "A free place from which OBJECT can be taken as far as is known, whether or not it is seen from there, and the action for that; nil where
there is none, and where LOCATION is no place to reach from, which costmaps find, but the very place to go to. Two values. What stands in
the way is put aside."
  (let ((item (btr-belief:get-designator-object (desig:current-desig object))))
    (when (and item (desig:desig-prop-value location :reachable-for))
      (let* ((name (btr:name item))
             (others (when (top-grasp-p object) (list (from-above object pick-up-action))))
             (chosen pick-up-action))
        (flet ((try ()
                 (setf chosen (or (find-if (lambda (action)
                                             (pr2-proj-reasoning::possible-p (lambda () (try-picking-up name object arm action t))))
                                           others)
                                  pick-up-action))
                 (unless (member chosen others)
                   (try-picking-up name object arm pick-up-action t))))
          (let ((place (or (free-place-around (btr:pose item) #'try)
                           (let ((pose (make-room-for item #'try)))
                             (and pose (free-place-around (btr:pose item) #'try pose))))))
            (when place
              (values place chosen))))))))

(defun in-hand-p (object)
  "Whether the robot holds OBJECT; true where no world knows it."
  (let ((item (btr-belief:get-designator-object (desig:current-desig object))))
    (or (null item)
        (and (btr:object-attached (btr:get-robot-object) item) t))))

(defun fetch-from (place object arm pick-up-action may-be-hidden)
  "Go to a place, take an object from there, and park the arms. Where the fingers miss it, the robot looks again, once."
  (let ((?place place))
    (exe:perform (desig:an action (type navigating) (location ?place))))
  (with-other-solutions (1 (fd-plans fetch) common-fail:gripper-low-level-failure)
      ((progn (pp-plans:park-arms) t)
       (cpl:fail 'common-fail:object-unreachable :object object :description "The fingers closed beside the object."))
    (pick-up-what-is-seen object arm pick-up-action may-be-hidden)
    (pp-plans:park-arms)
    (unless (in-hand-p object)
      (cpl:fail 'common-fail:gripper-closed-completely :description "The object slipped out of the hand."))))

(cpl:def-cram-function fetch (?object-designator ?arm ?pick-up-robot-location pick-up-action)
  "Go to an object, take it, and park the arms. Where it is out of reach, the robot goes to another place, ten times, and in the end to any
free place. Returns the object as it is known then."
  (flet ((give-up (&optional (description "The object was not taken from any of the places that were tried."))
           (multiple-value-bind (elsewhere action) (other-way-to-fetch ?pick-up-robot-location ?object-designator ?arm pick-up-action)
             (if elsewhere
                 (fetch-from elsewhere ?object-designator ?arm action t)
                 (cpl:fail 'common-fail:object-unfetchable :object ?object-designator :description description)))))
    (cpl:with-failure-handling
        ((desig:designator-error (problem)
           (roslisp:ros-warn (fd-plans fetch) "~a" problem)
           (give-up "The place to fetch the object from could not be resolved.")
           (return)))
      (with-other-solutions (10 (fd-plans fetch)
                             common-fail:navigation-goal-in-collision
                             common-fail:looking-high-level-failure
                             common-fail:perception-low-level-failure
                             common-fail:object-unreachable
                             common-fail:manipulation-low-level-failure)
          ((let ((elsewhere (next-solution ?pick-up-robot-location)))
             (when elsewhere (setf ?pick-up-robot-location elsewhere)))
           (return (give-up)))
        (let ((place (place-to-fetch-from ?pick-up-robot-location ?object-designator ?arm pick-up-action)))
          (if place
              (fetch-from place ?object-designator ?arm pick-up-action nil)
              (give-up))))))
  (desig:current-desig ?object-designator))
