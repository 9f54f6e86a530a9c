;;;; Arms and hands. Lists of joint states are in the order of ARM-JOINTS; lengths are metres, angles radians.

(in-package #:cram-pr2-description)

(defvar *standard-to-pr2-gripper-transform*
  (cl-transforms:make-transform (cl-transforms:make-identity-vector) (cl-transforms:matrix->quaternion #2A((0 1 0) (0 0 1) (1 0 0))))
  "From the standard gripper, whose z axis points at the object, to that of the PR2, whose x axis does.")

(defvar *tcp-in-ee-pose*
  (cl-transforms:make-pose (cl-transforms:make-3d-vector 0.2 0 0) (cl-transforms:make-identity-rotation))
  "Where the tool point is in the frame of the wrist.")

(defun get-hand-link-names (arm)
  "The names of the links of the hand of ARM, which is :LEFT or :RIGHT."
  (ecase arm
    (:left '("l_gripper_l_finger_tip_link" "l_gripper_r_finger_tip_link" "l_gripper_l_finger_link" "l_gripper_r_finger_link"
             "l_gripper_l_finger_tip_frame" "l_gripper_palm_link"))
    (:right '("r_gripper_l_finger_tip_link" "r_gripper_r_finger_tip_link" "r_gripper_l_finger_link" "r_gripper_r_finger_link"
              "r_gripper_l_finger_tip_frame" "r_gripper_palm_link"))))

(defun parking-pose (y)
  "A pose of a wrist beside the body, Y metres to the left, with the hand pointing down."
  (cl-transforms-stamped:make-pose-stamped
   "torso_lift_link" 0.0
   (cl-transforms:make-3d-vector 0.3 y -0.23)
   (cl-transforms:euler->quaternion :ay (/ pi 2))))

(defvar *left-parking-pose* (parking-pose 0.3))
(defvar *right-parking-pose* (parking-pose -0.3))

(def-fact-group pr2-arm-kinematics-facts (arm arm-joints arm-links arm-base-joints arm-base-links arm-tool-joints hand-links
                          end-effector-link robot-tool-frame gripper-joint gripper-link planning-group
                          standard-to-particular-gripper-transform tcp-in-ee-pose gripper-meter-to-joint-multiplier)

  (<- (arm pr2 :right))
  (<- (arm pr2 :left))

  (<- (arm-joints pr2 :left ("l_shoulder_pan_joint" "l_shoulder_lift_joint" "l_upper_arm_roll_joint" "l_elbow_flex_joint"
                             "l_forearm_roll_joint" "l_wrist_flex_joint" "l_wrist_roll_joint")))
  (<- (arm-joints pr2 :right ("r_shoulder_pan_joint" "r_shoulder_lift_joint" "r_upper_arm_roll_joint" "r_elbow_flex_joint"
                              "r_forearm_roll_joint" "r_wrist_flex_joint" "r_wrist_roll_joint")))

  (<- (arm-links pr2 :left ("l_shoulder_pan_link" "l_shoulder_lift_link" "l_upper_arm_roll_link" "l_upper_arm_link" "l_elbow_flex_link"
                            "l_forearm_roll_link" "l_forearm_link" "l_wrist_flex_link" "l_wrist_roll_link")))
  (<- (arm-links pr2 :right ("r_shoulder_pan_link" "r_shoulder_lift_link" "r_upper_arm_roll_link" "r_upper_arm_link" "r_elbow_flex_link"
                             "r_forearm_roll_link" "r_forearm_link" "r_wrist_flex_link" "r_wrist_roll_link")))

  (<- (arm-base-joints pr2 ?arm ("torso_lift_joint"))
    (arm pr2 ?arm))

  (<- (arm-base-links pr2 ?arm ("torso_lift_link"))
    (arm pr2 ?arm))

  (<- (arm-tool-joints pr2 :left ("l_gripper_palm_joint" "l_gripper_tool_joint")))
  (<- (arm-tool-joints pr2 :right ("r_gripper_palm_joint" "r_gripper_tool_joint")))

  (<- (hand-links pr2 ?arm ?links)
    (arm pr2 ?arm)
    (lisp-fun get-hand-link-names ?arm ?links))

  (<- (end-effector-link pr2 :left "l_wrist_roll_link"))
  (<- (end-effector-link pr2 :right "r_wrist_roll_link"))

  (<- (robot-tool-frame pr2 :left "l_gripper_tool_frame"))
  (<- (robot-tool-frame pr2 :right "r_gripper_tool_frame"))

  (<- (gripper-joint pr2 :left "l_gripper_l_finger_joint"))
  (<- (gripper-joint pr2 :left "l_gripper_r_finger_joint"))
  (<- (gripper-joint pr2 :right "r_gripper_l_finger_joint"))
  (<- (gripper-joint pr2 :right "r_gripper_r_finger_joint"))

  (<- (gripper-link pr2 :left ?link)
    (bound ?link)
    (lisp-pred search "l_gripper" ?link))
  (<- (gripper-link pr2 :right ?link)
    (bound ?link)
    (lisp-pred search "r_gripper" ?link))

  (<- (planning-group pr2 :left "left_arm"))
  (<- (planning-group pr2 :right "right_arm"))
  (<- (planning-group pr2 (:left :right) "both_arms"))
  (<- (planning-group pr2 (:right :left) "both_arms"))

  (<- (standard-to-particular-gripper-transform pr2 ?transform)
    (symbol-value *standard-to-pr2-gripper-transform* ?transform))

  (<- (tcp-in-ee-pose pr2 ?pose)
    (symbol-value *tcp-in-ee-pose* ?pose))

  (<- (gripper-meter-to-joint-multiplier pr2 5.0d0)))

(def-fact-group pr2-arm-states (robot-arms-parking-joint-states robot-arms-carrying-joint-states end-effector-parking-pose
                                robot-pre-grasp-joint-states)

  (<- (robot-arms-parking-joint-states pr2 ?states)
    (arm pr2 ?arm)
    (robot-arms-parking-joint-states pr2 ?states ?arm))

  (<- (robot-arms-parking-joint-states pr2 (("l_shoulder_pan_joint" 0.1709440184822959d0)
                                            ("l_shoulder_lift_joint" 1.1472294789783886d0)
                                            ("l_upper_arm_roll_joint" 1.9124515764640622d0)
                                            ("l_elbow_flex_joint" -1.66700794841958d0)
                                            ("l_forearm_roll_joint" 6.255471931555043d0)
                                            ("l_wrist_flex_joint" -0.07476630774212056d0)
                                            ("l_wrist_roll_joint" -14.7079336142174d0))
                                       :left))

  (<- (robot-arms-parking-joint-states pr2 (("r_shoulder_pan_joint" -0.08181428617939712d0)
                                            ("r_shoulder_lift_joint" 0.9781030555170612d0)
                                            ("r_upper_arm_roll_joint" -1.4665572091011352d0)
                                            ("r_elbow_flex_joint" -1.6859729116108224d0)
                                            ("r_forearm_roll_joint" -27.72481374424779d0)
                                            ("r_wrist_flex_joint" -0.10621948550701799d0)
                                            ("r_wrist_roll_joint" 7.662671673625887d0))
                                       :right))

  (<- (robot-arms-carrying-joint-states pr2 ?states)
    (arm pr2 ?arm)
    (robot-arms-carrying-joint-states pr2 ?states ?arm))

  (<- (robot-arms-carrying-joint-states pr2 (("l_shoulder_pan_joint" 1.9652919379395388d0)
                                             ("l_shoulder_lift_joint" -0.26499816732737785d0)
                                             ("l_upper_arm_roll_joint" 1.3837617139225473d0)
                                             ("l_elbow_flex_joint" -2.1224566064321584d0)
                                             ("l_forearm_roll_joint" 16.99646118944817d0)
                                             ("l_wrist_flex_joint" -0.07350789589924167d0)
                                             ("l_wrist_roll_joint" 0.0d0))
                                        :left))

  (<- (robot-arms-carrying-joint-states pr2 (("r_shoulder_pan_joint" -1.712587449591307d0)
                                             ("r_shoulder_lift_joint" -0.2567290370386635d0)
                                             ("r_upper_arm_roll_joint" -1.4633501125737374d0)
                                             ("r_elbow_flex_joint" -2.1221670650093913d0)
                                             ("r_forearm_roll_joint" 1.7663253481913623d0)
                                             ("r_wrist_flex_joint" -0.07942669250968948d0)
                                             ("r_wrist_roll_joint" 0.05106258161229582d0))
                                        :right))

  (<- (end-effector-parking-pose pr2 ?pose :left)
    (symbol-value *left-parking-pose* ?pose))
  (<- (end-effector-parking-pose pr2 ?pose :right)
    (symbol-value *right-parking-pose* ?pose))

  (<- (robot-pre-grasp-joint-states pr2 (("torso_lift_joint" 0.33d0))))
  (<- (robot-pre-grasp-joint-states pr2 (("torso_lift_joint" 0.165d0))))
  (<- (robot-pre-grasp-joint-states pr2 (("torso_lift_joint" 0.0d0)))))
