;;;; What the URDF file of the robot tells of its joints. ROBOT-DESCRIPTION-FILE, a predicate for descriptions of robots, names the file; the
;;;; ROS parameter robot_description, where it is set, comes before.

(in-package #:cram-robot-interfaces)

(defun description-source ()
  "The text of the ROS parameter robot_description, or the name of the robot's file."
  (or (and (eq (roslisp:node-status) :running)
           (roslisp:has-param "robot_description")
           (roslisp:get-param "robot_description"))
      (solution '?file '(and (robot ?robot) (robot-description-file ?robot ?file)))
      (error "It is not known which file describes the robot. Did you forget to load a robot description package?")))

(defun joint-figures (joint-name)
  "What is known of a joint, as a list: type, lower limit, upper limit, axis, position, rotation, parent link, child link."
  (uiop:symbol-call (py:import-module "cramhy_runtime.robot_world.joint_figures") '#:joint-figures
                    (description-source) joint-name))

(defun get-joint-type (joint-name)
  "The type of a joint: :FIXED, :REVOLUTE, :CONTINUOUS or :PRISMATIC."
  (values (intern (string-upcase (first (joint-figures joint-name))) :keyword)))

(defun get-joint-lower-limit (joint-name)
  "The least position of a joint, in radians or metres; nil for one that turns without end."
  (second (joint-figures joint-name)))

(defun get-joint-upper-limit (joint-name)
  "The greatest position of a joint, in radians or metres; nil for one that turns without end."
  (third (joint-figures joint-name)))

(defun get-joint-axis (joint-name)
  "The axis of a joint, as a vector in the frame of its child link."
  (apply #'cl-transforms:make-3d-vector (fourth (joint-figures joint-name))))

(defun get-joint-origin (joint-name)
  "Where the child link of a joint is in its parent link while the joint is at 0: a transform."
  (destructuring-bind (position rotation) (subseq (joint-figures joint-name) 4 6)
    (cl-transforms:make-transform (apply #'cl-transforms:make-3d-vector position)
                                  (apply #'cl-transforms:make-quaternion rotation))))

(defun get-joint-parent (joint-name)
  "The name of the link that a joint hangs from."
  (seventh (joint-figures joint-name)))

(defun get-joint-child (joint-name)
  "The name of the link that a joint moves."
  (eighth (joint-figures joint-name)))

(def-fact-group urdf-joint-facts ()

  (<- (joint-lower-limit ?robot ?joint ?limit)
    (robot ?robot)
    (lisp-fun get-joint-lower-limit ?joint ?limit))

  (<- (joint-upper-limit ?robot ?joint ?limit)
    (robot ?robot)
    (lisp-fun get-joint-upper-limit ?joint ?limit))

  (<- (joint-type ?robot ?joint ?type)
    (robot ?robot)
    (lisp-fun get-joint-type ?joint ?type))

  (<- (joint-axis ?robot ?joint ?axis)
    (robot ?robot)
    (lisp-fun get-joint-axis ?joint ?axis))

  (<- (joint-origin ?robot ?joint ?origin)
    (robot ?robot)
    (lisp-fun get-joint-origin ?joint ?origin))

  (<- (joint-parent-link ?robot ?joint ?link)
    (robot ?robot)
    (lisp-fun get-joint-parent ?joint ?link))

  (<- (joint-child-link ?robot ?joint ?link)
    (robot ?robot)
    (lisp-fun get-joint-child ?joint ?link))

  (<- (joint-parent ?robot ?joint ?link)
    (joint-parent-link ?robot ?joint ?link))

  (<- (joint-child ?robot ?joint ?link)
    (joint-child-link ?robot ?joint ?link)))
