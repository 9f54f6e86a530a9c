;;;; What the launch files of CRAM's branch devel put beside the plans: the descriptions of the robot and of the kitchen as ROS parameters, and
;;;; services that compute inverse kinematics. Where CRAM-ROBOT-INTERFACES names the parameters, as devel's does, STARTUP-ROS brings both,
;;;; unless the parameter server or a node has them already.

(in-package #:cram-bullet-reasoning)

(defparameter *descriptions*
  '(("*ROBOT-DESCRIPTION-PARAMETER*" "pr2.urdf") ("*ENVIRONMENT-DESCRIPTION-PARAMETER*" "kitchen.urdf"))
  "A variable of CRAM-ROBOT-INTERFACES that has the name of a parameter, and the file whose text the parameter gets.")

(defparameter *kinematics-services* '("kdl_ik_service/get_ik" "pr2_left_arm_kinematics/get_ik" "pr2_right_arm_kinematics/get_ik"))

(defun set-descriptions ()
  "Set the parameters of the descriptions that are not set."
  (loop for (name file) in *descriptions*
        for variable = (find-symbol name '#:cram-robot-interfaces)
        unless (roslisp:has-param (symbol-value variable))
          do (roslisp:set-param (symbol-value variable) (robot-world:description-text file))))

(defun kinematics (request)
  "The answer to a request moveit_msgs/GetPositionIK: the joints that bring a link of the robot to a pose, which is told in the frame of the
link from which on joints may move."
  (roslisp:with-fields ((link (ik_link_name ik_request)) (stamped (pose_stamped ik_request))
                        (joints (name joint_state robot_state ik_request)))
      request
    (let* ((robot (get-robot-object))
           (goal (from-msg stamped))
           (base (string-left-trim "/" (frame-id goal)))
           (found (and robot (member base (link-names robot) :test #'string=) (member link (link-names robot) :test #'string=)
                       (robot-world:reach-with robot base link (transform-pose (pose->transform (link-pose robot base)) goal)))))
      (flet ((position-of (joint)
               (or (cdr (assoc joint found :test #'string=)) (joint-state robot joint))))
        (roslisp:make-response
         'moveit_msgs-srv:getpositionik
         :solution (roslisp:make-msg "moveit_msgs/RobotState"
                                     :joint_state (make-joint-state-message
                                                   (when found (map 'list (lambda (joint) (list joint (position-of joint))) joints))))
         :error_code (roslisp:make-msg "moveit_msgs/MoveItErrorCodes"
                                       :val (roslisp-msg-protocol:symbol-code 'moveit_msgs-msg:moveiterrorcodes
                                                                              (if found :success :no_ik_solution))))))))

(defun offer-kinematics ()
  "Offer the services that no node has."
  (dolist (service *kinematics-services*)
    (unless (roslisp:wait-for-service service 0)
      (roslisp:register-service-fn service #'kinematics 'moveit_msgs-srv:getpositionik))))

(defun offer-descriptions-and-kinematics ()
  (set-descriptions)
  (offer-kinematics))

(when (find-symbol "*ROBOT-DESCRIPTION-PARAMETER*" '#:cram-robot-interfaces)
  (roslisp-utilities:register-ros-init-function offer-descriptions-and-kinematics 100))
