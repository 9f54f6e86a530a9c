;;;; What plans ask about a robot. The robot's description, such as CRAM-PR2-DESCRIPTION, answers.

(defpackage #:cram-robot-interfaces
  (:use #:common-lisp #:cram-prolog #:cram-designators)
  (:export
   ;; the robot
   #:robot #:robot-base-frame #:robot-odom-frame #:robot-torso-link-joint #:robot-description-file
   #:current-robot-symbol #:current-robot-package #:current-robot-name #:symbol-to-prolog-rule
   ;; arms and grippers
   #:arm #:required-arms #:available-arms #:arm-joints #:arm-links #:arm-base-joints #:arm-base-links #:arm-tool-joints #:hand-links
   #:end-effector-link #:robot-tool-frame #:gripper-joint #:gripper-link #:robot-arms-parking-joint-states
   #:robot-arms-carrying-joint-states #:end-effector-parking-pose #:robot-pre-grasp-joint-states #:planning-group
   #:standard-to-particular-gripper-transform #:tcp-in-ee-pose #:gripper-meter-to-joint-multiplier #:compute-iks
   ;; camera and neck
   #:camera-frame #:camera-minimal-height #:camera-maximal-height #:robot-pan-tilt-links #:robot-pan-tilt-joints
   #:robot-neck-parking-joint-states #:robot-neck-looking-joint-states
   ;; trajectories
   #:trajectory-point
   ;; joints
   #:joint-lower-limit #:joint-upper-limit #:joint-type #:joint-axis #:joint-origin #:joint-parent-link #:joint-child-link
   #:get-joint-lower-limit #:get-joint-upper-limit #:get-joint-type #:get-joint-axis #:get-joint-origin #:get-joint-parent
   #:get-joint-child
   ;; designators
   #:reachability-designator #:visibility-designator #:reachability-designator-p #:visibility-designator-p #:designator-reach-pose
   #:trajectory-desig? #:constraints-desig?))
