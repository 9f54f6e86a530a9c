;;;; Picking up and placing.

(in-package #:cram-mobile-pick-place-plans)

(defvar *grasps* (make-hash-table :test 'equal)
  "The grasp by which each object was picked up, by its name and the arm that holds it: an object is put down as it was taken.")

(defun remember-grasp (object-name arm grasp)
  (setf (gethash (list object-name arm) *grasps*) grasp))

(defun forget-grasp (object-name arm)
  (remhash (list object-name arm) *grasps*))

(defun remembered-grasp (object-name arm)
  "The grasp by which ARM took the object, or nil."
  (values (gethash (list object-name arm) *grasps*)))

(defun name-of (object-designator)
  (desig:desig-prop-value (desig:current-desig object-designator) :name))

(defmacro passing-over-failures ((topic &key but) &body body)
  "Do BODY; what arms or grippers could not do is logged, and no matter. BUT: a class of failures that do matter."
  `(cpl:with-failure-handling
       ((common-fail:manipulation-low-level-failure (failure)
          (unless (typep failure ',but)
            (roslisp:ros-warn ,topic "~a~%Ignoring." failure)
            (return))))
     ,@body))

(defun perform-along (?type ?left-poses ?right-poses)
  "Perform an action that moves arms along poses."
  (exe:perform (desig:an action (type ?type) (left-poses ?left-poses) (right-poses ?right-poses))))

(defun arms-of (arm)
  (if (listp arm) arm (list arm)))

(cpl:def-cram-function pick-up (?object-designator ?arm ?gripper-opening ?grip-effort ?grasp
                                ?left-reach-poses ?right-reach-poses
                                ?left-grasping-poses ?right-grasping-poses
                                ?left-lift-poses ?right-lift-poses)
  "Take an object: open the gripper and reach at once, grasp, grip, and lift. Poses of an arm that is not used are nil."
  (cpl:par
    (progn
      (roslisp:ros-info (pick-place pick-up) "Opening gripper")
      (exe:perform (desig:an action (type setting-gripper) (gripper ?arm) (position ?gripper-opening))))
    (progn
      (roslisp:ros-info (pick-place pick-up) "Reaching")
      (perform-along :reaching ?left-reach-poses ?right-reach-poses)))
  (passing-over-failures ((pick-place pick-up))
    (perform-along :grasping ?left-grasping-poses ?right-grasping-poses))
  (roslisp:ros-info (pick-place pick-up) "Gripping")
  (exe:perform (desig:an action
                         (type gripping)
                         (gripper ?arm)
                         (desig:when ?grip-effort (effort ?grip-effort))))
  (roslisp:ros-info (pick-place pick-up) "Assert grasp into knowledge base")
  (let ((name (name-of ?object-designator)))
    (dolist (arm (arms-of ?arm))
      (remember-grasp name arm ?grasp)
      (tell cpoe:object-attached :object-name name :arm arm)))
  (roslisp:ros-info (pick-place pick-up) "Lifting")
  (passing-over-failures ((pick-place pick-up) :but common-fail:gripper-closed-completely) ; it slipped, in a physical world
    (perform-along :lifting ?left-lift-poses ?right-lift-poses)))

(cpl:def-cram-function place (?object-designator ?arm
                              ?left-reach-poses ?right-reach-poses
                              ?left-put-poses ?right-put-poses
                              ?left-retract-poses ?right-retract-poses
                              ?placing-location)
  "Put down an object that is held: reach, put, open the gripper, and draw the arm back. Poses of an arm that is not used are nil."
  (declare (ignore ?placing-location))
  (roslisp:ros-info (pick-place place) "Reaching")
  (perform-along :reaching ?left-reach-poses ?right-reach-poses)
  (roslisp:ros-info (pick-place place) "Putting")
  (passing-over-failures ((pick-place place))
    (perform-along :putting ?left-put-poses ?right-put-poses))
  (roslisp:ros-info (pick-place place) "Opening gripper")
  (exe:perform (desig:an action (type releasing) (gripper ?arm)))
  (roslisp:ros-info (pick-place place) "Retract grasp in knowledge base")
  (let ((name (name-of ?object-designator)))
    (dolist (arm (arms-of ?arm))
      (forget-grasp name arm)
      (tell cpoe:object-detached :object-name name :arm arm)))
  (roslisp:ros-info (pick-place place) "Retracting")
  (passing-over-failures ((pick-place place))
    (perform-along :retracting ?left-retract-poses ?right-retract-poses)))
