;;;; Base, torso, head, grippers and arms.

(in-package #:cram-pr2-projection)

(defvar *torso-step* 0.01
  "How far apart the heights of the torso are from which an arm tries to reach, in metres.")

(defun arm-poses-equal-accurate (one other)
  "Whether two lists (ARM POSE) mean the same: the same arm, and poses less than a micrometre and 1e-5 radians apart."
  (and (eql (first one) (first other))
       (cram-tf:poses-equal-p (second one) (second other) 1.0d-6 1.0d-5)))

(defun arm-pose-hash-code (arm-and-pose)
  "A number that is the same for lists (ARM POSE) that are `arm-poses-equal-accurate'."
  (sxhash (first arm-and-pose)))

(sb-ext:define-hash-table-test arm-poses-equal-accurate arm-pose-hash-code)

(defvar *ik-solution-cache* (make-hash-table :test 'arm-poses-equal-accurate)
  "For programs that clear it: what was computed for arms is remembered by what computes it.")

(defvar *frames-follow* t
  "Whether frames move with the links; what only tries motions has no use for that.")

(defun touched ()
  "After a motion: the frames are where the links are."
  (when *frames-follow*
    (btr-belief:set-tf-from-bullet))
  nil)

(defun fail-if-hindered (problem unreachable not-reached)
  "In a physical world: fail when PROBLEM, the value of a motion, tells what hindered it. UNREACHABLE and NOT-REACHED are classes of
failures: there was no way, or the joints did not get where they were sent."
  (when (and (consp problem) (member (first problem) '(:no-way :not-reached :slipped)))
    (touched)
    (destructuring-bind (kind text) problem
      (cpl:fail (ecase kind
                  (:no-way unreachable)
                  (:not-reached not-reached)
                  (:slipped 'common-fail:gripper-closed-completely))
                :description (format nil "In the physical world ~a." text)))))

(defun drive (pose-stamped)
  "Put the base at a pose in the room."
  (let ((things (robot-world:drive (robot) (parts) (cram-tf:ensure-pose-in-frame pose-stamped cram-tf:*fixed-frame* :use-zero-time t))))
    (fail-if-hindered things 'common-fail:navigation-pose-unreachable 'common-fail:navigation-goal-not-reached)
    (when things
      (cpl:fail 'common-fail:navigation-pose-unreachable
                :description (format nil "The robot would touch ~{~a~^, ~} at ~a." (mapcar #'btr:name things) pose-stamped)))
    (touched)))

(defun drive-with-others (pose-stamped)
  "As `drive'; where arms that are moving at the same time are in the way, once they are not."
  (let ((joints (btr:joint-states (robot))))
    (cpl:with-retry-counters ((waits 10))
      (cpl:with-failure-handling
          ((common-fail:navigation-pose-unreachable (failure)
             (declare (ignore failure))
             (cpl:do-retry waits
               (cpl:sleep 0.1)
               (let ((now (btr:joint-states (robot))))
                 (unless (equalp now joints)
                   (setf joints now)
                   (cpl:retry))))))
        (drive pose-stamped)))))

(defun move-torso (height)
  "Raise or lower the torso."
  (let ((beyond (robot-world:move-torso (robot) (parts) height)))
    (fail-if-hindered beyond 'common-fail:torso-goal-unreachable 'common-fail:torso-goal-not-reached)
    (touched)
    (when beyond
      (cpl:fail 'common-fail:torso-goal-not-reached :description (format nil "Torso goal ~a was out of joint limits" height)))))

(defun look-at (goal-type goal)
  "Look at a pose, at the origin of a frame, or :FORWARD."
  (let ((beyond (ecase goal-type
                  (:pose (look-at-pose goal))
                  (:frame (look-at-pose (cram-tf:frame-to-pose-in-fixed-frame goal)))
                  (:direction
                   (unless (eq goal :forward)
                     (error "~a direction is unknown for PR2 projection PTU" goal))
                   (robot-world:look-forward (robot) (parts))))))
    (fail-if-hindered beyond 'common-fail:ptu-goal-unreachable 'common-fail:ptu-goal-not-reached)
    (touched)
    (when beyond
      (cpl:fail 'common-fail:ptu-goal-not-reached :description "Look action wanted to twist the neck"))))

(defun look-at-pose (pose)
  (let ((pose (cram-tf:ensure-pose-in-frame pose cram-tf:*fixed-frame* :use-zero-time t)))
    (robot-world:look-at (robot) (parts) (cl-transforms:origin pose))))

(defun check-arm (arm failure)
  "Fail with FAILURE, the class of a failure, when the robot has no such arm."
  (let ((arms (values-of '?arm `(cram-robot-interfaces:arm ,(btr:get-robot-name) ?arm))))
    (unless (member arm arms)
      (cpl:fail failure :description (format nil "The robot has no ~(~a~) arm; it has ~{~(~a~)~^, ~}." arm arms)))))

(defun gripper-action (action arm &optional effort)
  "Open, close or grip with an arm, or with several; ACTION may be a width in metres. EFFORT, in newtons, matters in a physical world."
  (if (listp arm)
      (dolist (each arm) (gripper-action action each effort))
      (let ((found (etypecase (progn (check-arm arm 'common-fail:gripper-goal-not-reached) action)
                     ((eql :open) (robot-world:set-fingers (robot) (parts) arm) t)
                     ((eql :close) (robot-world:set-fingers (robot) (parts) arm 0) t)
                     ((eql :grip) (robot-world:grip (robot) (parts) arm effort))
                     (number (robot-world:set-fingers (robot) (parts) arm action) t))))
        (touched)
        (unless found
          (cpl:fail 'common-fail:gripper-closed-completely :description "There was no object to grip")))))

(defun move-tcp (left-pose right-pose &optional collision-mode)
  "Bring the tools of the arms to poses in the frame of the base. In a physical world COLLISION-MODE tells whether hands may touch things."
  (let ((goals (loop for (arm pose) in `((:left ,left-pose) (:right ,right-pose))
                     when pose
                       do (check-arm arm 'common-fail:manipulation-pose-unreachable)
                       and collect (cons arm (tool-pose pose)))))
    (when goals
      (let ((failed (robot-world:move-tools (robot) (parts) goals :lenient collision-mode)))
        (fail-if-hindered failed 'common-fail:manipulation-pose-unreachable 'common-fail:manipulation-goal-not-reached)
        (touched)
        (when failed
          (destructuring-bind (arm heights) failed
            (cpl:fail 'common-fail:manipulation-pose-unreachable
                      :description (format nil "~a is unreachable for EE." (cdr (assoc arm goals)))
                      :hint (format nil "No posture of the ~(~a~) arm was found from ~d height~:p of the torso." arm heights))))))))

(defun tool-pose (pose)
  (unless (string= (cl-transforms-stamped:frame-id pose) cram-tf:*robot-base-frame*)
    (error "Arm movement goals should be given in robot base frame"))
  pose)

(defmethod cram-robot-interfaces:compute-iks ((pose-stamped cl-transforms-stamped:pose-stamped) &key arm &allow-other-keys)
  "A list of one list of joint states, (name position) each, with which the tool of ARM is at a pose; nil, if there are none."
  (let ((states (robot-world:posture-for (robot) (parts) arm (cram-tf:ensure-pose-in-frame pose-stamped cram-tf:*robot-base-frame*
                                                                                          :use-zero-time t))))
    (when states (list states))))

(defun move-joints (left right)
  "Bring the joints of the arms to lists of values."
  (loop for (arm values) in `((:left ,left) (:right ,right))
        when values
          do (check-arm arm 'common-fail:manipulation-pose-unreachable)
             (let ((moved (robot-world:move-arm-joints (robot) (parts) arm values)))
               (fail-if-hindered moved 'common-fail:manipulation-pose-unreachable 'common-fail:manipulation-goal-not-reached)
               (unless moved
                 (error "[PROJECTION MOVE-JOINTS] length of joints list is incorrect."))))
  (touched))

(defun move-with-constraints (constraints)
  (declare (ignore constraints))
  (warn "Moving with constraints is not supported in projection! Ignoring."))

;;; In a physical world fingers hold a flat thing only when their tips lie beside it. The tips end before the point that grasps are told for.

(defparameter *tips-before-tool* 0.009
  "How far before the tool's point the tips of the fingers end, metres.")

(defparameter *least-hold* 0.009
  "How much of a flat thing is to be between the tips, metres.")

(defun deeper (name)
  "How much deeper than told a hand goes from above, for a thing of the current world that is to be held by friction, metres."
  (let ((thing (and (robot-world:physical-p btr:*current-bullet-world*) (btr:object btr:*current-bullet-world* name))))
    (if thing
        (let ((half (/ (cl-transforms:z (btr:calculate-bb-dims thing)) 2)))
          (max 0 (min (- (+ *tips-before-tool* *least-hold*) half) (- (+ *tips-before-tool* half) 0.002))))
        0)))

(defmethod obj-int:get-object-grasping-poses :around (name type arm (grasp (eql :top)) transform)
  (declare (ignore type arm transform))
  (destructuring-bind (before 2nd-before grasp-pose after 2nd-after) (call-next-method)
    (let* ((way (cl-transforms:make-3d-vector (deeper name) 0 0))
           (moved (cl-transforms:v+ (cl-transforms:origin grasp-pose) (cl-transforms:rotate (cl-transforms:orientation grasp-pose) way))))
      (list before 2nd-before (cl-transforms-stamped:copy-pose-stamped grasp-pose :origin moved) after 2nd-after))))
