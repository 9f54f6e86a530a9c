;;;; Occasions: what holds in the current world.

(in-package #:cram-bullet-reasoning-belief-state)

(defun get-designator-object-name (designator)
  "The name of the object that DESIGNATOR was found to be, or that it says, or nil."
  (or (gethash (desig:first-desig designator) *names*)
      (desig:desig-prop-value designator :name)))

(defun get-designator-object (designator)
  "The object in the current world that DESIGNATOR means, or nil."
  (let ((name (get-designator-object-name designator)))
    (and name (btr:object btr:*current-bullet-world* name))))

(defun held-objects ()
  "A list (name arm) for each object that an arm of the robot holds."
  (let ((robot (btr:get-robot-object)))
    (when robot
      (loop for (name . links) in (btr:attached-objects robot)
            append (loop for solution in (cut:force-ll (prolog `(and (cram-robot-interfaces:robot ?robot)
                                                                     (cram-robot-interfaces:end-effector-link ?robot ?arm ?link))))
                         when (member (cut:var-value '?link solution) links :test #'equal)
                           collect (list name (cut:var-value '?arm solution)))))))

(defun designators-named (name)
  "The newest designators of the chains of objects that were found to be NAME, in the order in which they were made."
  (remove-duplicates
   (loop for designator in (desig:get-all-designators)
         when (and (typep designator 'desig:object-designator)
                   (eq (get-designator-object-name designator) name))
           collect (desig:current-desig designator))
   :from-end t))

(defun names-of-type (designator)
  "The names of the items in the current world that have the type of DESIGNATOR, when nothing else tells which of them it is."
  (let ((type (desig:desig-prop-value designator :type)))
    (unless (or (null type) (get-designator-object-name designator))
      (mapcar #'btr:name (btr:find-objects btr:*current-bullet-world*
                                           (lambda (thing) (and (typep thing 'btr:item) (member type (btr:item-types thing)))))))))

(defun stamped-pose (name)
  "Where the object of that name is in the room, or nil."
  (let ((object (btr:object btr:*current-bullet-world* name)))
    (when object
      (cl-transforms-stamped:pose->pose-stamped (or cram-tf:*fixed-frame* "map") 0.0 (btr:pose object)))))

(defun at-location-p (pose location)
  "Whether POSE is the one that LOCATION stands for now, or another one that its rules accept."
  (let ((location (desig:current-desig location)))
    (or (handler-case (desig:designator-solutions-equal pose (desig:reference location))
          (desig:designator-error () nil))
        (and (desig:validate-location-designator-solution location pose) t))))

(defun location-of (pose)
  "A location designator that stands for POSE."
  (desig:make-designator :location `((:pose ,pose))))

(def-fact-group occasions (cpoe:object-in-hand cpoe:object-picked cpoe:object-placed-at cpoe:loc object-designator-name)
  (<- (object-designator-name ?designator ?name)
    (lisp-type ?designator symbol)
    (== ?designator ?name))

  (<- (object-designator-name ?designator ?name)
    (lisp-type ?designator desig:designator)
    (lisp-fun get-designator-object-name ?designator ?name)
    (lisp-pred identity ?name))

  (<- (object-designator-name ?designator ?name)
    (lisp-type ?designator desig:object-designator)
    (lisp-fun names-of-type ?designator ?names)
    (member ?name ?names))

  (<- (cpoe:loc ?robot-or-object ?location)
    (bound ?robot-or-object)
    (object-designator-name ?robot-or-object ?name)
    (lisp-fun stamped-pose ?name ?pose)
    (lisp-pred identity ?pose)
    (-> (bound ?location)
        (lisp-pred at-location-p ?pose ?location)
        (lisp-fun location-of ?pose ?location)))

  (<- (cpoe:object-placed-at ?object ?location)
    (cpoe:loc ?object ?location)
    (not (cpoe:object-in-hand ?object)))

  (<- (cpoe:object-in-hand ?designator)
    (cpoe:object-in-hand ?designator ?arm))

  (<- (cpoe:object-in-hand ?designator ?arm)
    (lisp-fun held-objects ?held)
    (member (?name ?arm) ?held)
    (lisp-fun designators-named ?name ?designators)
    (member ?designator ?designators))

  (<- (cpoe:object-picked ?designator)
    (cpoe:object-in-hand ?designator)))
