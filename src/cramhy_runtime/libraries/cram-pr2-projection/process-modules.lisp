;;;; The process modules, and which motion is for which of them.

(in-package #:cram-pr2-projection)

(defmacro def-projection-module (name command-and-arguments &body body)
  "A process module that takes the reference of a motion apart: COMMAND and its ARGUMENTS are there in BODY."
  (destructuring-bind (command . arguments) command-and-arguments
    `(cpm:def-process-module ,name (motion)
       (destructuring-bind (,command ,@arguments) (desig:reference motion)
         (ecase ,command ,@body)))))

(def-projection-module pr2-proj-navigation (command argument)
  (cram-common-designators:move-base (drive-with-others argument)))

(def-projection-module pr2-proj-torso (command argument)
  (cram-common-designators:move-torso (move-torso argument)))

(def-projection-module pr2-proj-ptu (command goal-type goal)
  (cram-common-designators:move-head (look-at goal-type goal)))

(def-projection-module pr2-proj-perception (command argument)
  (cram-common-designators:detect (detect argument)))

(def-projection-module pr2-proj-grippers (command action arm &optional effort)
  (cram-common-designators:move-gripper-joint (gripper-action action arm effort)))

(def-projection-module pr2-proj-arms (command first &optional second third)
  (cram-common-designators:move-tcp (move-tcp first second third))
  (cram-common-designators:move-joints (move-joints first second))
  (cram-common-designators:move-with-constraints (move-with-constraints first)))

(def-fact-group pr2-projection-modules (cpm:matching-process-module cpm:available-process-module)

  (<- (cpm:matching-process-module ?motion pr2-proj-navigation)
    (desig:desig-prop ?motion (:type :going)))

  (<- (cpm:matching-process-module ?motion pr2-proj-torso)
    (desig:desig-prop ?motion (:type :moving-torso)))

  (<- (cpm:matching-process-module ?motion pr2-proj-ptu)
    (desig:desig-prop ?motion (:type :looking)))

  (<- (cpm:matching-process-module ?motion pr2-proj-perception)
    (desig:desig-prop ?motion (:type :detecting)))

  (<- (cpm:matching-process-module ?motion pr2-proj-grippers)
    (desig:desig-prop ?motion (:type ?type))
    (member ?type (:gripping :moving-gripper-joint)))

  (<- (cpm:matching-process-module ?motion pr2-proj-grippers)
    (desig:desig-prop ?motion (:type ?type))
    (member ?type (:opening :closing))
    (desig:desig-prop ?motion (:gripper ?)))

  (<- (cpm:matching-process-module ?motion pr2-proj-arms)
    (desig:desig-prop ?motion (:type ?type))
    (member ?type (:moving-tcp :moving-arm-joints :moving-with-constraints)))

  (<- (cpm:available-process-module ?module)
    (member ?module (pr2-proj-navigation pr2-proj-torso pr2-proj-ptu pr2-proj-perception pr2-proj-grippers pr2-proj-arms))
    (symbol-value cram-projection:*projection-environment* pr2-bullet-projection-environment)))
