;;;; (an action (type picking-up) ...) and (an action (type placing) ...): which arm, which grasp, and the poses on the way.

(in-package #:cram-mobile-pick-place-plans)

(defun grasping-poses (side arm object-name object-type grasp object-transform)
  "The poses of the arm on SIDE, or nil where ARM, one or a list, is not that one."
  (when (member side (arms-of arm))
    (obj-int:get-object-grasping-poses object-name object-type side grasp object-transform)))

(defun split-poses (poses)
  "The first two of POSES, the third, and the rest: the way to an object, where it is grasped, and the way on."
  (when poses
    (list (subseq poses 0 2) (subseq poses 2 3) (subseq poses 3))))

(defun split-poses-for-placing (poses)
  "The same the other way round: an object is put down as it was lifted."
  (split-poses (reverse poses)))

(defun base-frame ()
  "The name of the frame of the robot's base."
  (or cram-tf:*robot-base-frame*
      (cut:var-value '?frame (cut:lazy-car (prolog '(and (cram-robot-interfaces:robot ?robot)
                                                     (cram-robot-interfaces:robot-base-frame ?robot ?frame)))))))

(defun reached-p (pose arm)
  "Whether ARM reaches a pose; true where nothing can tell."
  (or (null (compute-applicable-methods #'cram-robot-interfaces:compute-iks (list pose)))
      (cram-robot-interfaces:compute-iks pose :arm arm)))

(defun grasp-reached-p (grasp arm object-name object-type transform &optional (pick #'second))
  "Whether ARM, or each of a list, reaches the grasp, and the pose that PICK takes of all."
  (handler-case
      (every (lambda (side)
               (let ((poses (obj-int:get-object-grasping-poses object-name object-type side grasp transform)))
                 (and (reached-p (funcall pick poses) side) (reached-p (third poses) side))))
             (arms-of arm))
    (error () nil)))

(defun those-reached-first (grasps arm object-name object-type transform)
  "GRASPS in their order, but those before the others that ARM can reach."
  (loop for grasp in (cut:force-ll grasps)
        if (grasp-reached-p grasp arm object-name object-type transform)
          collect grasp into reached
        else
          collect grasp into others
        finally (return (append reached others))))

(defun turned (transform quarters)
  "TRANSFORM, with so many quarters of a turn about the vertical."
  (cram-tf:copy-transform-stamped
   transform :rotation (cl-transforms:q* (cl-transforms:axis-angle->quaternion (cl-transforms:make-3d-vector 0 0 1) (* quarters pi 0.5))
                                         (cl-transforms:rotation transform))))

(defparameter *taken-by-the-rim* '(:bowl)
  "Types of round things that a hand takes by their rim, on whichever side.")

(defun transforms-to-take (object-type transform)
  "TRANSFORM; of what is taken by its rim also the quarter turns of it, which put the hand on another side."
  (cons transform
        (when (member object-type *taken-by-the-rim*)
          (loop for quarters from 1 to 3 collect (turned transform quarters)))))

(defun transforms-to-place (grasp arm object-name object-type transform)
  "TRANSFORM; where that is out of reach, and the orientation of such objects does not matter, first those of its turns that are reached."
  (flet ((reached (transform) (grasp-reached-p grasp arm object-name object-type transform #'fourth)))
    (append (unless (or (reached transform) (prolog `(obj-int:orientation-matters ,object-type)))
              (remove-if-not #'reached (loop for quarters from 1 to 3 collect (turned transform quarters))))
            (list transform))))

(defun target-transform (object-name target-pose)
  "The transform from the robot's base to an object that is at TARGET-POSE."
  (cram-tf:pose-stamped->transform-stamped
   (cram-tf:ensure-pose-in-frame target-pose (base-frame) :use-zero-time t)
   (roslisp-utilities:rosify-underscores-lisp-name object-name)))

(def-fact-group pick-and-place-plans (desig:action-grounding)

  (<- (desig:action-grounding ?designator (pick-up ?current-object ?arm ?gripper-opening ?effort ?grasp
                                                   ?left-reach-poses ?right-reach-poses
                                                   ?left-grasp-poses ?right-grasp-poses
                                                   ?left-lift-poses ?right-lift-poses))
    (spec:property ?designator (:type :picking-up))
    (spec:property ?designator (:object ?object))
    (desig:current-designator ?object ?current-object)
    (spec:property ?current-object (:type ?object-type))
    (spec:property ?current-object (:name ?object-name))
    (lisp-fun obj-int:get-object-transform ?current-object ?seen-transform)
    (lisp-pred identity ?seen-transform)
    (lisp-fun transforms-to-take ?object-type ?seen-transform ?transforms)
    (member ?transform ?transforms)
    (arm-to-use ?designator ?arm)
    (grasp-to-use ?designator ?object-name ?object-type ?transform ?arm ?grasp)
    (lisp-fun obj-int:get-object-type-gripping-effort ?object-type ?effort)
    (lisp-fun obj-int:get-object-type-gripper-opening ?object-type ?gripper-opening)
    (lisp-fun grasping-poses :left ?arm ?object-name ?object-type ?grasp ?transform ?left-poses)
    (lisp-fun grasping-poses :right ?arm ?object-name ?object-type ?grasp ?transform ?right-poses)
    (lisp-fun split-poses ?left-poses ?left-parts)
    (lisp-fun split-poses ?right-poses ?right-parts)
    (parts ?left-parts ?left-reach-poses ?left-grasp-poses ?left-lift-poses)
    (parts ?right-parts ?right-reach-poses ?right-grasp-poses ?right-lift-poses))

  (<- (arm-to-use ?designator ?arm)
    (-> (spec:property ?designator (:arm ?given))
        (equal ?arm ?given)
        (and (cram-robot-interfaces:robot ?robot)
             (cram-robot-interfaces:arm ?robot ?arm)
             (not (cpoe:object-in-hand ?held ?arm)))))

  (<- (grasp-to-use ?designator ?object-name ?object-type ?transform ?arm ?grasp)
    (-> (spec:property ?designator (:grasp ?given))
        (equal ?grasp ?given)
        (and (lisp-fun obj-int:calculate-object-faces ?transform (?facing-robot ?bottom))
             (-> (obj-int:object-rotationally-symmetric ?object-type)
                 (equal ?symmetric t)
                 (equal ?symmetric nil))
             (lisp-fun obj-int:get-object-type-grasps ?object-type ?facing-robot ?bottom ?symmetric ?arm ?grasps)
             (lisp-fun those-reached-first ?grasps ?arm ?object-name ?object-type ?transform ?ordered-grasps)
             (member ?grasp ?ordered-grasps))))

  (<- (parts nil nil nil nil))

  (<- (parts (?first ?second ?third) ?first ?second ?third))

  (<- (desig:action-grounding ?designator (place ?current-object ?arm
                                                 ?left-reach-poses ?right-reach-poses
                                                 ?left-put-poses ?right-put-poses
                                                 ?left-retract-poses ?right-retract-poses
                                                 ?target))
    (spec:property ?designator (:type :placing))
    (held-object ?designator ?current-object ?arm)
    (spec:property ?current-object (:type ?object-type))
    (spec:property ?current-object (:name ?object-name))
    (place-to-use ?designator ?current-object ?object-name ?target ?transform)
    (grasp-in-hand ?object-type ?object-name ?arm ?transform ?grasp)
    (lisp-fun transforms-to-place ?grasp ?arm ?object-name ?object-type ?transform ?transforms)
    (member ?placed ?transforms)
    (lisp-fun grasping-poses :left ?arm ?object-name ?object-type ?grasp ?placed ?left-poses)
    (lisp-fun grasping-poses :right ?arm ?object-name ?object-type ?grasp ?placed ?right-poses)
    (lisp-fun split-poses-for-placing ?left-poses ?left-parts)
    (lisp-fun split-poses-for-placing ?right-poses ?right-parts)
    (parts ?left-parts ?left-reach-poses ?left-put-poses ?left-retract-poses)
    (parts ?right-parts ?right-reach-poses ?right-put-poses ?right-retract-poses))

  (<- (held-object ?designator ?current-object ?arm)
    (-> (spec:property ?designator (:arm ?given-arm))
        (equal ?arm ?given-arm)
        (true))
    (-> (spec:property ?designator (:object ?given-object))
        (desig:current-designator ?given-object ?current-object)
        (true))
    (-> (and (bound ?arm) (bound ?current-object))
        (true)
        (and (-> (bound ?arm) (true) (and (cram-robot-interfaces:robot ?robot) (cram-robot-interfaces:arm ?robot ?arm)))
             (cpoe:object-in-hand ?held ?arm)
             (desig:current-designator ?held ?current-held)
             (-> (bound ?current-object)
                 (desig:desig-equal ?current-object ?current-held)
                 (equal ?current-object ?current-held)))))

  (<- (place-to-use ?designator ?object ?object-name ?target ?transform)
    (-> (spec:property ?designator (:target ?given-target))
        (and (desig:current-designator ?given-target ?target)
             (desig:designator-groundings ?target ?poses)
             (member ?pose ?poses)
             (lisp-fun target-transform ?object-name ?pose ?transform))
        (and (equal ?target nil)
             (lisp-fun obj-int:get-object-transform ?object ?transform)
             (lisp-pred identity ?transform))))

  (<- (grasp-in-hand ?object-type ?object-name ?arm ?transform ?grasp)
    (-> (lisp-pred grasp-of ?object-name ?arm)
        (lisp-fun grasp-of ?object-name ?arm ?grasp)
        (and (lisp-fun obj-int:calculate-object-faces ?transform (?facing-robot ?bottom))
             (lisp-fun obj-int:get-object-type-grasps ?object-type ?facing-robot ?bottom nil ?arm ?grasps)
             (once (member ?grasp ?grasps))))))

(defun grasp-of (object-name arm)
  "The grasp by which ARM, or the first of a list, took the object, or nil."
  (remembered-grasp object-name (first (arms-of arm))))
