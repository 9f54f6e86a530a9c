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

(def-fact-group btr-occasions (cpoe:object-in-hand cpoe:object-picked object-designator-name)
  (<- (object-designator-name ?designator ?name)
    (lisp-type ?designator symbol)
    (== ?designator ?name))

  (<- (object-designator-name ?designator ?name)
    (lisp-type ?designator desig:designator)
    (lisp-fun get-designator-object-name ?designator ?name)
    (lisp-pred identity ?name))

  (<- (cpoe:object-in-hand ?designator)
    (cpoe:object-in-hand ?designator ?arm))

  (<- (cpoe:object-in-hand ?designator ?arm)
    (lisp-fun held-objects ?held)
    (member (?name ?arm) ?held)
    (lisp-fun designators-named ?name ?designators)
    (member ?designator ?designators))

  (<- (cpoe:object-picked ?designator)
    (cpoe:object-in-hand ?designator)))
