;;;; The world at the beginning: the kitchen, and the robot with its arms parked.

(in-package #:cram-bullet-reasoning-belief-state)

(defvar *robot-urdf* nil "The description of the robot, once it was read.")
(defvar *kitchen-urdf* nil "The description of the kitchen, once it was read.")
(defvar *robot-parameter* "robot_description" "The ROS parameter with the robot's URDF.")
(defvar *kitchen-parameter* "kitchen_description" "The ROS parameter with the kitchen's URDF.")
(defvar *world-mode* :kinematic
  "How `clear-belief' makes the world anew: :KINEMATIC, in which motions happen at once, or :PHYSICAL, with controllers, contacts and friction.")
(defvar *spawn-debug-window* t "For code that sets it: there is no window.")

(defvar *names* (make-hash-table :test 'eq)
  "Designators, and the names of the objects that they were found to be.")

(defun parameter-text (parameter file)
  "The text of a ROS parameter; that of FILE, where there is none."
  (or (ignore-errors (roslisp:get-param parameter nil))
      (robot-world:description-text file)))

(defun robot-file ()
  "The URDF file that the robot's description names; that of the PR2, where it names none."
  (let ((solution (cut:lazy-car (prolog '(and (cram-robot-interfaces:robot ?robot)
                                              (cram-robot-interfaces:robot-description-file ?robot ?file))))))
    (if solution (cut:var-value '?file solution) "pr2.urdf")))

(defun robot-urdf ()
  (or *robot-urdf*
      (setf *robot-urdf* (cl-urdf::read-robot (substitute #\Space #\\ (parameter-text *robot-parameter* (robot-file))) *robot-parameter*))))

(defun kitchen-urdf ()
  (or *kitchen-urdf*
      (setf *kitchen-urdf* (cl-urdf::read-robot (parameter-text *kitchen-parameter* "kitchen.urdf") *kitchen-parameter*))))

(defun there (type name &rest arguments)
  "The object of that name in the current world, which is added at the origin where there is none."
  (or (btr:object btr:*current-bullet-world* name)
      (apply #'btr:add-object btr:*current-bullet-world* type name '((0 0 0) (0 0 0 1)) arguments)))

(defun setup-world-database ()
  "Fill the current world with the kitchen and the robot, whose arms are parked. What is there stays where it is."
  (let ((world btr:*current-bullet-world*)
        (robot (btr:get-robot-name)))
    (there :static-plane :floor :normal '(0 0 1) :constant 0)
    (there :urdf :kitchen :urdf (kitchen-urdf) :collision-group :static-filter
                          :collision-mask '(:default-filter :character-filter) :compound t)
    (if (null robot)
        (warn "ROBOT was not defined. Have you loaded a robot package?")
        (let ((machine (there :urdf robot :urdf (robot-urdf))))
          (dolist (solution (cut:force-ll (prolog `(cram-robot-interfaces:robot-arms-parking-joint-states ,robot ?states ?arm))))
            (btr:set-robot-state-from-joints (cut:var-value '?states solution) machine))
          (btr:set-robot-state-from-joints `((,(torso-joint robot) 0.15)) machine)))
    world))

(defun torso-joint (robot)
  (cut:var-value '?joint (cut:lazy-car (prolog `(cram-robot-interfaces:robot-torso-link-joint ,robot ?link ?joint)))))

(defmethod cram-occasions-events:clear-belief bullet-world ()
  (setf btr:*current-bullet-world* (robot-world:make-world *world-mode*))
  (setup-world-database)
  (clrhash *names*))
