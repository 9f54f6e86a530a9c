;;;; The predicates about a robot. Nothing holds until a robot's description says it.

(in-package #:cram-robot-interfaces)

(defmacro define-unknown (group &body goals)
  "Define a fact group of predicates that a description may extend, and in which none of GOALS, such as (ARM ?ROBOT ?ARM), holds."
  `(def-fact-group ,group ,(remove-duplicates (mapcar #'first goals))
     ,@(loop for goal in goals collect `(<- ,goal (fail)))))

(define-unknown robot
  (robot ?name)
  (robot-base-frame ?robot ?frame)
  (robot-odom-frame ?robot ?frame)
  (robot-torso-link-joint ?robot ?link ?joint)
  (robot-description-file ?robot ?file))

(define-unknown arms
  (arm ?robot ?arm)
  (required-arms ?object ?arms)
  (available-arms ?object ?arms)
  (arm-joints ?robot ?arm ?joints)
  (arm-links ?robot ?arm ?links)
  (arm-base-joints ?robot ?arm ?joints)
  (arm-base-links ?robot ?arm ?links)
  (arm-tool-joints ?robot ?arm ?joints)
  (hand-links ?robot ?arm ?links)
  (end-effector-link ?robot ?arm ?link)
  (robot-tool-frame ?robot ?arm ?frame)
  (gripper-joint ?robot ?arm ?joint)
  (gripper-link ?robot ?arm ?link)
  (planning-group ?robot ?arms ?name)
  (standard-to-particular-gripper-transform ?robot ?transform)
  (tcp-in-ee-pose ?robot ?pose)
  (gripper-meter-to-joint-multiplier ?robot ?multiplier))

(define-unknown arm-states
  (robot-arms-parking-joint-states ?robot ?states)
  (robot-arms-parking-joint-states ?robot ?states ?arm)
  (robot-arms-carrying-joint-states ?robot ?states)
  (robot-arms-carrying-joint-states ?robot ?states ?arm)
  (end-effector-parking-pose ?robot ?pose ?arm)
  (robot-pre-grasp-joint-states ?robot ?states))

(define-unknown ptu
  (camera-frame ?robot ?frame)
  (camera-minimal-height ?robot ?height)
  (camera-maximal-height ?robot ?height)
  (robot-pan-tilt-links ?robot ?pan ?tilt)
  (robot-pan-tilt-joints ?robot ?pan ?tilt)
  (robot-neck-parking-joint-states ?robot ?states)
  (robot-neck-looking-joint-states ?robot ?states))

(define-unknown trajectories
  (trajectory-point ?designator ?point ?side)
  (trajectory-point ?designator ?robot ?point ?side))

(defgeneric compute-iks (pose-stamped &key link-name arm robot-state seed-state pose-stamped-frame tcp-in-ee-pose)
  (:documentation "Joint states with which the link LINK-NAME of ARM is at POSE-STAMPED, as a list of solutions; nil if there are none."))

(defun solution (variable goal)
  "The value of VARIABLE in the first solution of GOAL, or nil; and whether it has a value."
  (let* ((solutions (prolog goal))
         (value (if solutions (cut:var-value variable (cut:lazy-car solutions)) variable)))
    (if (cut:is-var value) (values nil nil) (values value t))))

(defun current-robot-symbol ()
  "The symbol of the robot whose description is loaded, or nil."
  (values (solution '?robot '(robot ?robot))))

(defun current-robot-package ()
  "The package of `current-robot-symbol': that of the robot's description."
  (symbol-package (current-robot-symbol)))

(defun current-robot-name ()
  "The name of `current-robot-symbol'."
  (symbol-name (current-robot-symbol)))

(defun symbol-to-prolog-rule (the-symbol &rest parameters)
  "What a predicate of the robot's own says. Its name is that of THE-SYMBOL, and it is asked with PARAMETERS and one more argument, whose
value is returned. THE-SYMBOL itself where the robot's description has no such symbol; its own symbol, where that says nothing."
  (let ((predicate (find-symbol (string-upcase the-symbol) (current-robot-package))))
    (if predicate
        (multiple-value-bind (value known) (solution '?result `(,predicate ,@parameters ?result))
          (if known value predicate))
        the-symbol)))
