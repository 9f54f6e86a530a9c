;;;; Which links and joints move: what the robot's description says, in the form in which the world wants it.

(in-package #:cram-pr2-projection)

(defvar *parts* nil
  "The parts of a robot, and its name before them.")

(defun solution (goal)
  "The first solution of GOAL."
  (or (cut:lazy-car (prolog goal))
      (error "The robot's description has no answer to ~s." goal)))

(defun value (variable goal)
  (cut:var-value variable (solution goal)))

(defun values-of (variable goal)
  "All values of VARIABLE in the solutions of GOAL."
  (mapcar (lambda (solution) (cut:var-value variable solution)) (cut:force-ll (prolog goal))))

(defun told (variable goal default)
  "As `value', or DEFAULT where the robot's description does not tell it."
  (let ((solution (cut:lazy-car (prolog goal))))
    (if solution (cut:var-value variable solution) default)))

(defun tool-of (robot arm tip)
  "Where the tool point of ARM is in the frame of its wrist: as told, else where the tool frame is."
  (or (told '?pose `(cram-robot-interfaces:tcp-in-ee-pose ,robot ?pose) nil)
      (let* ((machine (btr:get-robot-object))
             (tool (btr:link-pose machine (value '?frame `(cram-robot-interfaces:robot-tool-frame ,robot ,arm ?frame)))))
        (cl-transforms:transform->pose
         (cl-transforms:transform* (cl-transforms:transform-inv (cl-transforms:pose->transform (btr:link-pose machine tip)))
                                   (cl-transforms:pose->transform tool))))))

(defun arm-parts (robot arm links
                  &aux (tip (value '?link `(cram-robot-interfaces:end-effector-link ,robot ,arm ?link)))
                    (fingers (values-of '?joint `(cram-robot-interfaces:gripper-joint ,robot ,arm ?joint))))
  (robot-world:make-arm
   :joints (value '?joints `(cram-robot-interfaces:arm-joints ,robot ,arm ?joints))
   :base (first (value '?links `(cram-robot-interfaces:arm-base-links ,robot ,arm ?links)))
   :tip tip
   :tool (tool-of robot arm tip)
   :fingers fingers
   :hand (remove-if-not (lambda (link) (prolog `(cram-robot-interfaces:gripper-link ,robot ,arm ,link))) links)
   :open (or (cram-robot-interfaces:get-joint-upper-limit (first fingers)) 0)
   :factor (told '?number `(cram-robot-interfaces:gripper-meter-to-joint-multiplier ,robot ?number) 1)))

(defun read-parts (robot)
  (let ((neck (solution `(cram-robot-interfaces:robot-pan-tilt-joints ,robot ?pan ?tilt)))
        (links (btr:link-names (btr:get-robot-object))))
    (robot-world:make-parts
     :torso (value '?joint `(cram-robot-interfaces:robot-torso-link-joint ,robot ?link ?joint))
     :pan (cut:var-value '?pan neck)
     :tilt (cut:var-value '?tilt neck)
     :cameras (values-of '?frame `(cram-robot-interfaces:camera-frame ,robot ?frame))
     :arms (loop for arm in (values-of '?arm `(cram-robot-interfaces:arm ,robot ?arm))
                 collect (cons arm (arm-parts robot arm links))))))

(defun parts ()
  "The parts of the robot whose description is loaded."
  (let ((robot (btr:get-robot-name)))
    (unless (eq (car *parts*) robot)
      (setf *parts* (cons robot (read-parts robot))))
    (cdr *parts*)))

(defun robot ()
  "The robot in the current world."
  (or (btr:get-robot-object)
      (error "There is no robot in the current world. (cram-occasions-events:clear-belief) builds the world anew.")))
