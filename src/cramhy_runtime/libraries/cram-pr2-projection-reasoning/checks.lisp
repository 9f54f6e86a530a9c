;;;; Checks. Each tries the groundings of a designator in turn, and moves the designator on to the first that works: ask for its
;;;; current-desig afterwards. Only the places where motions end are looked at, not the ways there.

(in-package #:cram-pr2-projection-reasoning)

(defun simulated-p ()
  "Whether motions move the robot of the current world."
  (eq cram-projection:*projection-environment* 'pr2-proj:pr2-bullet-projection-environment))

(defmacro in-simulation (&body body)
  "Do BODY where motions move the robot of the current world."
  `(flet ((body () ,@body))
     (if (simulated-p) (body) (pr2-proj:with-simulated-robot (body)))))

(defmacro trying-solutions (((designator variable) tries &rest failures) (again-form &key none-left too-many) &body body)
  "Do BODY with the current solution of DESIGNATOR, which is VARIABLE there. After one of FAILURES do AGAIN-FORM and BODY with the next
solution, TRIES times at most. NONE-LEFT and TOO-MANY are what happens when there is no other solution, and when there were too many."
  (let ((left (gensym "LEFT")) (failure (gensym "FAILURE")))
    `(let ((,variable (desig:current-desig ,designator)))
       (cpl:with-retry-counters ((,left ,tries))
         (cpl:with-failure-handling
             (((or ,@failures) (,failure)
                (roslisp:ros-debug (projection reasoning) "~a" ,failure)
                ,again-form
                (cpl:do-retry ,left
                  (let ((next (handler-case (desig:next-solution ,variable) (desig:designator-error () nil))))
                    (unless next ,none-left)
                    (setf ,variable next)
                    (cpl:retry)))
                ,too-many))
           ,@body)))))

;;; Places.

(defun check-navigating-collisions (navigation-location-desig &optional (navigation-location-samples-to-try 30))
  "Find a solution of a location at which the robot touches nothing, and leave the robot there; in a physical world it stays where it is."
  (flet ((give-up (description)
           (cpl:fail 'common-fail:navigation-goal-in-collision :description description)))
    (in-simulation
      (cpl:with-failure-handling
          ((desig:designator-error (problem)
             (roslisp:ros-warn (projection reasoning) "~a" problem)
             (give-up "Designator could not be resolved")))
        (trying-solutions ((navigation-location-desig location) navigation-location-samples-to-try
                           common-fail:navigation-low-level-failure)
            (nil :none-left (give-up "No other samples in designator")
                 :too-many (give-up "Couldn't find a nav pose after all retries"))
          (btr:with-current-bullet-world (world-to-try-in)
            (pr2-proj::drive (desig:reference location))))))
    (btr-belief:set-tf-from-bullet)
    (desig:current-desig navigation-location-desig)))

;;; Arms.

(defun touched-names (but)
  "The names of what the robot touches and does not hold, without those in the list BUT."
  (set-difference (btr:robot-colliding-objects-without-attached) but))

(defun move-arms-to (left-pose right-pose harmless required)
  "Bring the tools there. A pose that is not REQUIRED may be out of reach; nothing may be touched but what is HARMLESS."
  (when (cpl:with-failure-handling
            ((common-fail:manipulation-low-level-failure (failure)
               (unless required
                 (roslisp:ros-debug (projection reasoning) "~a~%Ignoring." failure)
                 (return nil))))
          (pr2-proj::move-tcp left-pose right-pose)
          t)
    (let ((touched (touched-names harmless)))
      (when touched
        (cpl:fail 'common-fail:manipulation-goal-in-collision
                  :description (format nil "The robot would touch ~{~a~^, ~}." touched))))))

(defun move-arms-along (left-poses right-poses harmless required &aux (pr2-proj::*frames-follow* nil))
  "Bring the tools along their poses. REQUIRED is :LAST, :ALL or nil: which of them have to be reached."
  (loop for count from (max (length left-poses) (length right-poses)) downto 1
        for left = left-poses then (rest left)
        for right = right-poses then (rest right)
        do (move-arms-to (first left) (first right) harmless (or (eq required :all) (and (eq required :last) (= count 1))))))

(defun world-to-try-in ()
  "The current world; a copy of it, in which motions happen at once, when it is a physical one."
  (if (robot-world:physical-p btr:*current-bullet-world*)
      (btr:copy-world btr:*current-bullet-world*)
      btr:*current-bullet-world*))

(defmacro in-world-for-now (&body body)
  "Do BODY, and put the world back to what it was; also (BACK) does that. A physical world is not touched at all."
  `(let* ((world (world-to-try-in))
          (state (btr:get-state world)))
     (flet ((back ()
              (btr:restore-world-state state world)
              (btr-belief:set-tf-from-bullet)))
       (unwind-protect (btr:with-current-bullet-world world
                         (unwind-protect (progn ,@body) (back)))
         (unless (eq world btr:*current-bullet-world*)
           (btr-belief:set-tf-from-bullet))))))

(defun try-picking-up (reference)
  "Move the arms as the plan of REFERENCE, what a picking-up action stands for, would move them."
  (destructuring-bind (object arm opening effort grasp left-reach right-reach left-grasp right-grasp left-lift right-lift) (rest reference)
    (declare (ignore effort grasp))
    (let ((harmless (list (desig:desig-prop-value object :name))))
      (let ((pr2-proj::*frames-follow* nil))
        (pr2-proj::gripper-action opening arm))
      (move-arms-along left-reach right-reach harmless :last)
      (move-arms-along left-grasp right-grasp harmless :all)
      (move-arms-along left-lift right-lift (cons :kitchen harmless) nil))))

(defun places-of-grasp (reference)
  "Where the tools are when they grip, in millimetres, for REFERENCE, what a picking-up action stands for."
  (destructuring-bind (left-grasp right-grasp) (subseq reference 8 10)
    (loop for pose in (append left-grasp right-grasp)
          for origin = (cl-transforms:origin pose)
          collect (mapcar (lambda (metres) (round metres 0.001))
                          (list (cl-transforms:x origin) (cl-transforms:y origin) (cl-transforms:z origin))))))

(defun check-picking-up-collisions (pick-up-action-desig &optional (retries 30))
  "Find a grounding of an action of picking up, of which all poses that count are reached, and nothing is touched but the object."
  (flet ((give-up ()
           (cpl:fail 'common-fail:object-unreachable
                     :object (desig:desig-prop-value pick-up-action-desig :object)
                     :description "No more pick-up samples to try: every arm and grasp is out of reach, or touches something.")))
    (in-simulation
      (in-world-for-now
        (cpl:with-failure-handling
            ((desig:designator-error (problem)
               (roslisp:ros-warn (projection reasoning) "~a" problem)
               (give-up)))
          (let ((tried ()))
            (trying-solutions ((pick-up-action-desig action) retries
                               common-fail:manipulation-low-level-failure common-fail:manipulation-goal-in-collision)
                ((back) :none-left (give-up) :too-many (give-up))
              (let* ((reference (desig:reference action))
                     (way (list* (third reference) (sixth reference) (places-of-grasp reference))))
                (when (member way tried :test #'equal)
                  (cpl:fail 'common-fail:manipulation-goal-in-collision :description "That arm and grasp were tried."))
                (push way tried)
                (try-picking-up reference)))))))
    (desig:current-desig pick-up-action-desig)))

(defun try-placing (reference)
  "Move the arms as the plan of REFERENCE, what a placing action stands for, would move them; what is touched is only told."
  (destructuring-bind (object arm left-reach right-reach left-put right-put left-retract right-retract &rest target) (rest reference)
    (declare (ignore arm target left-retract right-retract))
    (let ((harmless (list (desig:desig-prop-value object :name))))
      (cpl:with-failure-handling
          ((common-fail:manipulation-goal-in-collision (failure)
             (roslisp:ros-warn (projection reasoning) "~a Placing all the same." failure)
             (return)))
        (move-arms-along left-reach right-reach harmless :last)
        (move-arms-along left-put right-put harmless :all)))))

(defun check-placing-collisions (placing-action-desig &optional (retries 30))
  "Find a grounding of a placing action whose poses that count are reached."
  (flet ((give-up ()
           (cpl:fail 'common-fail:object-unreachable
                     :object (desig:desig-prop-value placing-action-desig :object)
                     :description "No more putting-down samples to try: every place is out of reach.")))
    (in-simulation
      (in-world-for-now
        (cpl:with-failure-handling
            ((desig:designator-error (problem)
               (roslisp:ros-warn (projection reasoning) "~a" problem)
               (give-up)))
          (trying-solutions ((placing-action-desig action) retries common-fail:manipulation-low-level-failure)
              ((back) :none-left (give-up) :too-many (give-up))
            (try-placing (desig:reference action))))))
    (desig:current-desig placing-action-desig)))

(defun move-joint-of (environment joint distance)
  "Move a joint of the furniture by so many metres, with all that is in it."
  (let ((furniture (btr:object btr:*current-bullet-world* environment)))
    (when (and furniture (btr:joint-state furniture joint))
      (incf (btr:joint-state furniture joint) distance))))

(defun try-container (reference)
  "Move the arms as the plan of REFERENCE, what an action of opening or closing a container stands for, would move them. The container
moves along once it is gripped."
  (destructuring-bind (plan arm opening distance left-reach right-reach left-grasp right-grasp left-move right-move joint environment) reference
    (let ((pr2-proj::*frames-follow* nil))
      (pr2-proj::gripper-action opening arm))
    (move-arms-along left-reach right-reach '(:kitchen) :last)
    (move-arms-along left-grasp right-grasp '(:kitchen) :last)
    (move-joint-of environment joint (if (string= plan "CLOSE-CONTAINER") (- distance) distance))
    (move-arms-along left-move right-move '(:kitchen) :last)))

(defun check-environment-manipulation-collisions (action-desig &optional (retries 30))
  "Find a grounding of an action of opening or closing a container whose poses are reached."
  (flet ((give-up ()
           (cpl:fail 'common-fail:environment-unreachable
                     :description "No more samples to try: every arm is out of reach of the handle, or touches something.")))
    (in-simulation
      (in-world-for-now
        (cpl:with-failure-handling
            ((desig:designator-error (problem)
               (roslisp:ros-warn (projection reasoning) "~a" problem)
               (give-up)))
          (trying-solutions ((action-desig action) retries
                             common-fail:manipulation-low-level-failure common-fail:manipulation-goal-in-collision)
              ((back) :none-left (give-up) :too-many (give-up))
            (try-container (desig:reference action))))))
    (desig:current-desig action-desig)))
