;;;; cram-btr-visibility-costmap: for (a location (visible-for robot) (object o)), places above which a camera of the robot sees the object.

(defpackage #:cram-btr-visibility-costmap
  (:nicknames #:btr-vis-cm)
  (:use #:common-lisp #:prolog #:btr)
  (:export #:visible #:make-object-visibility-costmap #:visible-from-place-p))

(in-package #:cram-btr-visibility-costmap)

(defmethod location-costmap:costmap-generator-name->score ((name (eql 'visible-costmap))) 20)

(defun camera-heights (robot)
  "A list of the lowest and the highest height of the cameras of ROBOT."
  (let ((solution (cut:lazy-car (prolog `(and (cram-robot-interfaces:camera-minimal-height ,robot ?low)
                                              (cram-robot-interfaces:camera-maximal-height ,robot ?high))))))
    (if solution
        (list (cut:var-value '?low solution) (cut:var-value '?high solution))
        '(1.0 1.5))))

(defun make-object-visibility-costmap (object robot distance)
  "A cost function: which part of OBJECT is seen from above a place, up to DISTANCE metres away from it along x and y."
  (destructuring-bind (low high) (camera-heights robot)
    (robot-world:make-visible-cost object distance low high (object *current-bullet-world* robot))))

(defun object-to-see (designator)
  "The object in the current world that a location is to see, or nil."
  (let ((object (or (desig:desig-prop-value designator :object) (desig:desig-prop-value designator :obj))))
    (and object (btr-belief:get-designator-object (desig:current-desig object)))))

(def-fact-group bullet-reasoning-location-desig (location-costmap:desig-costmap)
  (<- (location-costmap:desig-costmap ?designator ?costmap)
    (cram-robot-interfaces:visibility-designator ?designator)
    (desig:desig-prop ?designator (:visible-for ?robot))
    (lisp-fun object-to-see ?designator ?object)
    (lisp-pred identity ?object)
    (location-costmap:visibility-costmap-size ?distance)
    (once (location-costmap:costmap ?costmap))
    (location-costmap:costmap-add-function visible-costmap (make-object-visibility-costmap ?object ?robot ?distance) ?costmap)))

(defun visible-from-place-p (robot object pose)
  "Whether ROBOT touches nothing at POSE, and sees OBJECT from there when it looks at it. Tried in a copy of the world."
  (let* ((world (copy-world *current-bullet-world*))
         (copy (object world (name robot))))
    (setf (pose copy) pose)
    (with-current-bullet-world world
      (and (null (set-difference (mapcar #'name (find-objects-in-contact world copy)) (mapcar #'first (attached-objects copy)) :test #'equal))
           (prolog `(and (head-pointing-at ,world ,(name robot) ,(pose object))
                         (visible ,world ,(name robot) ,(name object))))
           t))))

(defun validate-designator-solution (designator pose)
  "Accept a place from which the robot sees what it is to see, and where it touches nothing."
  (let ((object (and (typep pose 'cl-transforms:pose)
                     (cram-robot-interfaces:visibility-designator-p designator)
                     (object-to-see designator)))
        (robot (get-robot-object)))
    (cond ((not (and object robot)) :unknown)
          ((visible-from-place-p robot object (ensure-pose pose)) :accept)
          (t :reject))))

(desig:register-location-validation-function 10 validate-designator-solution "The robot sees the object from there.")
