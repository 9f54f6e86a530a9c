;;;; Plans of one motion, or of several of one kind.

(in-package #:cram-mobile-pick-place-plans)

(cpl:def-cram-function go-to-target (?location-designator)
  "Drive to a place. It is not tried again: whoever knows other places may."
  (unwind-protect
       (with-retries ((common-fail:navigation-low-level-failure) 0 (pick-place go))
         (exe:perform (desig:a motion (type going) (target ?location-designator))))
    (tell cpoe:robot-state-changed)))

(cpl:def-cram-function perceive (?object-designator &key (object-chosing-function #'identity))
  "Look for an object. Returns what was found, of several what OBJECT-CHOSING-FUNCTION chooses, equated with ?OBJECT-DESIGNATOR."
  (with-retries ((common-fail:perception-low-level-failure)
                 (if (desig:desig-prop-value ?object-designator :cad-model) 1 4)
                 (pick-place perceive))
    (let* ((found (exe:perform (desig:a motion (type detecting) (object ?object-designator))))
           (chosen (funcall object-chosing-function found)))
      (dolist (object (if (listp found) found (list found)))
        (tell cpoe:object-perceived-event :object-designator object :perception-source :whatever))
      (desig:equate ?object-designator chosen)
      chosen)))

(defun pose-list (pose-or-poses)
  (if (listp pose-or-poses) pose-or-poses (list pose-or-poses)))

(defun move-arms (?left-pose ?right-pose ?collision-mode)
  "Move the tools of those arms that have a pose."
  (flet ((location (?pose) (when ?pose (desig:a location (pose ?pose)))))
    (let ((?left-target (location ?left-pose))
          (?right-target (location ?right-pose)))
      (unwind-protect
           (exe:perform (desig:a motion
                                 (type moving-tcp)
                                 (desig:when ?left-target (left-target ?left-target))
                                 (desig:when ?right-target (right-target ?right-target))
                                 (desig:when ?collision-mode (collision-mode ?collision-mode))))
        (tell cpoe:robot-state-changed)))))

(cpl:def-cram-function move-arms-in-sequence (left-poses right-poses &optional ?collision-mode)
  "Move the tools along poses, each arm along its own. That the last ones are reached is what counts: failures on the way are passed over,
but when something is lifted, whose ?COLLISION-MODE is :ALLOW-HAND, not that it has slipped out of the hand."
  (loop for (left-pose . more-left) on (pad left-poses right-poses)
        for (right-pose . more-right) on (pad right-poses left-poses)
        do (if (or more-left more-right)
               (cpl:with-failure-handling
                   ((common-fail:manipulation-low-level-failure (failure)
                      (unless (and (eq ?collision-mode :allow-hand) (typep failure 'common-fail:gripper-closed-completely))
                        (roslisp:ros-warn (pick-place move-arms-in-sequence) "~a~%Ignoring." failure)
                        (return))))
                 (move-arms left-pose right-pose ?collision-mode))
               (move-arms left-pose right-pose ?collision-mode))))

(defun pad (poses others)
  "POSES as a list that is at least as long as that of OTHERS; an arm that is there already stays."
  (let* ((poses (pose-list poses))
         (missing (- (length (pose-list others)) (length poses))))
    (append poses (loop repeat missing collect nil))))

(defun joint-values (predicate arm)
  "The values of the joint states that PREDICATE tells of ARM, or nil."
  (let ((solution (cut:lazy-car
                   (prolog `(and (cram-robot-interfaces:robot ?robot) (,predicate ?robot ?states ,arm))))))
    (mapcar #'second (when solution (cut:var-value '?states solution)))))

(defun parking-values (arm carry)
  "The joint values of ARM, parked; with CARRY, so that it can carry something."
  (or (joint-values (if carry
                        'cram-robot-interfaces:robot-arms-carrying-joint-states
                        'cram-robot-interfaces:robot-arms-parking-joint-states)
                    arm)
      (error "ROBOT-ARMS-PARKING-JOINT-STATES undefined! Did you forget to load a robot description package?")))

(defun move-joints (?left ?right)
  "Move those arms that have joint values. Failures are passed over."
  (cpl:with-failure-handling
      ((common-fail:manipulation-low-level-failure (failure)
         (roslisp:ros-warn (pick-place park-arms) "~a~%Ignoring." failure)
         (return)))
    (exe:perform (desig:a motion
                          (type moving-arm-joints)
                          (desig:when ?left (left-configuration ?left))
                          (desig:when ?right (right-configuration ?right)))))
  (tell cpoe:robot-state-changed))

(defun something-held-p ()
  (and (prolog '(cpoe:object-in-hand ?object)) t))

(defun all-arms ()
  "The arms of the robot; both sides while no robot is described."
  (or (mapcar (lambda (solution) (cut:var-value '?arm solution))
              (cut:force-ll (prolog '(and (cram-robot-interfaces:robot ?robot) (cram-robot-interfaces:arm ?robot ?arm)))))
      '(:left :right)))

(cpl:def-cram-function park-arms (&key (arm (all-arms)) (carry t))
  "Move an arm, or several, where they are out of the way; with CARRY, or while something is held, where they can carry it."
  (let* ((arms (if (listp arm) arm (list arm)))
         (carry (or carry (something-held-p)))
         (left (when (member :left arms) (parking-values :left carry)))
         (right (when (member :right arms) (parking-values :right carry))))
    (cond (carry (move-joints left right))
          (t (when left (move-joints left nil))
             (when right (move-joints nil right))))))

(defun configuration-values (arm configuration)
  "The joint values of ARM in a CONFIGURATION: nil for none, a list of values, or a name."
  (if (listp configuration)
      configuration
      (case configuration
        ((:park :carry) (parking-values arm t))
        (:tucked (parking-values arm nil))
        (t (error "There is no configuration ~(~a~) of an arm; there are park, carry and tucked, and lists of joint values." configuration)))))

(cpl:def-cram-function position-arms (?left-configuration ?right-configuration)
  "Move the joints of the arms to configurations: :PARK, :CARRY, :TUCKED or a list of joint values; nil for an arm that stays."
  (let ((arms (all-arms)))
    (flet ((values-of (arm configuration)
             (when (member arm arms) (configuration-values arm configuration))))
      (move-joints (values-of :left ?left-configuration) (values-of :right ?right-configuration)))))

(defun torso-height (position)
  "The position of the joint of the torso, metres, that POSITION means: a number, or :UPPER-LIMIT, :LOWER-LIMIT or :MIDDLE."
  (if (numberp position)
      position
      (let* ((joint (cut:var-value '?joint (cut:lazy-car (prolog '(and (cram-robot-interfaces:robot ?robot)
                                                                   (cram-robot-interfaces:robot-torso-link-joint ?robot ?link ?joint))))))
             (lower (cram-robot-interfaces:get-joint-lower-limit joint))
             (upper (cram-robot-interfaces:get-joint-upper-limit joint)))
        (case position
          (:upper-limit upper)
          (:lower-limit lower)
          (:middle (/ (+ lower upper) 2))
          (t (error "There is no height ~(~a~) of the torso; there are numbers of metres, upper-limit, lower-limit and middle." position))))))

(cpl:def-cram-function move-torso (?position)
  "Raise or lower the torso: ?POSITION is in metres, or :UPPER-LIMIT, :LOWER-LIMIT or :MIDDLE."
  (let ((?height (torso-height ?position)))
    (unwind-protect
         (exe:perform (desig:a motion (type moving-torso) (joint-angle ?height)))
      (tell cpoe:robot-state-changed))))

(defmacro moving-gripper ((topic) motion)
  "Perform a motion of a gripper. Failures are passed over."
  `(cpl:with-failure-handling
       ((common-fail:gripper-low-level-failure (failure)
          (roslisp:ros-warn ,topic "~a~%Ignoring." failure)
          (return)))
     (unwind-protect (exe:perform ,motion)
       (tell cpoe:robot-state-changed))))

(cpl:def-cram-function release (?left-or-right)
  "Open a gripper, or several."
  (moving-gripper ((pick-place release))
    (desig:a motion (type opening) (gripper ?left-or-right))))

(cpl:def-cram-function open-or-close-gripper (?left-or-right ?action-type)
  "Open or close a gripper: ?ACTION-TYPE is :OPENING or :CLOSING."
  (moving-gripper ((pick-place open-or-close-gripper))
    (desig:a motion (type ?action-type) (gripper ?left-or-right))))

(cpl:def-cram-function set-gripper-to-position (?left-or-right ?position)
  "Open or close a gripper so far: ?POSITION is the width, in metres."
  (moving-gripper ((pick-place set-gripper-to-position))
    (desig:a motion (type moving-gripper-joint) (gripper ?left-or-right) (joint-angle ?position))))

(cpl:def-cram-function grip (?left-or-right ?effort)
  "Close a gripper on something, with so much force. It is tried twice."
  (unwind-protect
       (with-retries ((common-fail:gripper-low-level-failure) 1 (pick-place grip))
         (exe:perform (desig:a motion
                               (type gripping)
                               (gripper ?left-or-right)
                               (desig:when ?effort (effort ?effort)))))
    (tell cpoe:robot-state-changed)))

(defun looking-motion (target frame direction object)
  "The motion of looking at the first of these that is given."
  (cond (target (let ((?target target)) (desig:a motion (type looking) (target ?target))))
        (frame (let ((?frame frame)) (desig:a motion (type looking) (frame ?frame))))
        (direction (let ((?direction direction)) (desig:a motion (type looking) (direction ?direction))))
        (object (let ((?pose (obj-int:get-object-pose (desig:current-desig object))))
                  (unless ?pose
                    (cpl:fail 'common-fail:ptu-low-level-failure
                              :description (format nil "It is not known where to look for ~a: it was not seen yet." object)))
                  (desig:a motion (type looking) (target (desig:a location (pose ?pose))))))
        (t (error "LOOK-AT needs a :TARGET, a :FRAME, a :DIRECTION or an :OBJECT."))))

(cpl:def-cram-function look-at (&key target frame direction object)
  "Turn the camera to a place, to a frame of tf, into a direction such as :FORWARD, or to where an object was seen."
  (unwind-protect
       (with-retries ((common-fail:ptu-low-level-failure) 1 (pick-place look-at))
         (exe:perform (looking-motion target frame direction object)))
    (tell cpoe:robot-state-changed)))
