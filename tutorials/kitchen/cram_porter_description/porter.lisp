;;;; The porter: a column that rolls, with a head and one arm, on its right. All that plans know of it.

(defpackage #:cram-porter-description
  (:use #:common-lisp #:cram-prolog #:cram-robot-interfaces)
  (:export #:porter))

(in-package #:cram-porter-description)

(defvar *urdf* (namestring (asdf:system-relative-pathname :cram-porter-description "porter.urdf")))

(defvar *standard-to-porter-gripper-transform*
  (cl-transforms:make-transform (cl-transforms:make-identity-vector) (cl-transforms:matrix->quaternion #2A((0 1 0) (0 0 1) (1 0 0))))
  "From the standard gripper, whose z axis points at the object, to that of the porter, whose x axis does.")

(def-fact-group porter (robot robot-description-file robot-base-frame robot-odom-frame robot-torso-link-joint)
  (<- (robot porter))
  (<- (robot-description-file porter ?file)
    (symbol-value *urdf* ?file))
  (<- (robot-base-frame porter "base_footprint"))
  (<- (robot-odom-frame porter "odom"))
  (<- (robot-torso-link-joint porter "column" "lift")))

(def-fact-group porter-arm (arm arm-joints arm-links arm-base-joints arm-base-links end-effector-link robot-tool-frame
                            gripper-joint gripper-link hand-links standard-to-particular-gripper-transform
                            gripper-meter-to-joint-multiplier)
  (<- (arm porter :right))
  (<- (arm-joints porter :right ("shoulder_pan" "shoulder_lift" "upper_arm_roll" "elbow" "forearm_roll" "wrist_flex" "wrist_roll")))
  (<- (arm-links porter :right ("shoulder" "upper_arm_lift" "upper_arm" "elbow_link" "forearm" "wrist_link" "wrist")))
  (<- (arm-base-joints porter :right ("lift")))
  (<- (arm-base-links porter :right ("column")))
  (<- (end-effector-link porter :right "wrist"))
  (<- (robot-tool-frame porter :right "gripper_tool"))
  (<- (gripper-joint porter :right "left_finger_slide"))
  (<- (gripper-joint porter :right "right_finger_slide"))
  (<- (gripper-link porter :right ?link)
    (bound ?link)
    (member ?link ("gripper_palm" "gripper_left_finger" "gripper_right_finger")))
  (<- (hand-links porter :right ("gripper_palm" "gripper_left_finger" "gripper_right_finger")))
  (<- (gripper-meter-to-joint-multiplier porter 0.5))
  (<- (standard-to-particular-gripper-transform porter ?transform)
    (symbol-value *standard-to-porter-gripper-transform* ?transform)))

(def-fact-group porter-arm-states (robot-arms-parking-joint-states robot-arms-carrying-joint-states robot-pre-grasp-joint-states)
  (<- (robot-arms-parking-joint-states porter ?states)
    (robot-arms-parking-joint-states porter ?states :right))
  (<- (robot-arms-parking-joint-states porter ?states :right)
    (robot-arms-carrying-joint-states porter ?states :right))
  (<- (robot-arms-carrying-joint-states porter ?states)
    (robot-arms-carrying-joint-states porter ?states :right))
  (<- (robot-arms-carrying-joint-states porter (("shoulder_pan" -1.7) ("shoulder_lift" -0.26) ("upper_arm_roll" -1.46) ("elbow" -2.12)
                                                ("forearm_roll" 1.77) ("wrist_flex" -0.08) ("wrist_roll" 0.05))
                                        :right))
  (<- (robot-pre-grasp-joint-states porter (("lift" 0.3)))))

(def-fact-group porter-head (camera-frame camera-minimal-height camera-maximal-height robot-pan-tilt-links robot-pan-tilt-joints
                             robot-neck-parking-joint-states robot-neck-looking-joint-states)
  (<- (camera-frame porter "camera"))
  (<- (camera-minimal-height porter 1.35))
  (<- (camera-maximal-height porter 1.75))
  (<- (robot-pan-tilt-links porter "neck" "head"))
  (<- (robot-pan-tilt-joints porter "head_pan" "head_tilt"))
  (<- (robot-neck-parking-joint-states porter (("head_pan" 0.0) ("head_tilt" 0.0))))
  (<- (robot-neck-looking-joint-states porter (("head_pan" 0.0) ("head_tilt" 0.0)))))
