;;;; The plans. The arm reaches the handle, grips it, moves it, lets it go and draws back; the belief state hears how far it was moved.

(in-package #:cram-pr2-environment-manipulation)

(defun move-container (event ?arm ?opening distance left-reach right-reach left-grasp right-grasp left-move right-move joint environment)
  (cpl:par
    (perform (an action (type setting-gripper) (gripper ?arm) (position ?opening)))
    (pp-plans::perform-along :reaching left-reach right-reach))
  (pp-plans::perform-along :grasping left-grasp right-grasp)
  (perform (an action (type gripping) (gripper ?arm)))
  (pp-plans::passing-over-failures ((environment-manipulation pull))
    (pp-plans::perform-along (if (plusp distance) :pulling :pushing) (first-of left-move) (first-of right-move)))
  (cram-occasions-events:on-event
   (make-instance event :joint-name joint :side ?arm :environment environment :distance (abs distance)))
  (perform (an action (type releasing) (gripper ?arm)))
  (pp-plans::passing-over-failures ((environment-manipulation retract))
    (pp-plans::perform-along :retracting (rest left-move) (rest right-move)))
  nil)

(defun first-of (poses)
  (when poses (list (first poses))))

(cpl:def-cram-function open-container (arm gripper-opening distance left-reach-poses right-reach-poses left-grasp-poses right-grasp-poses
                                           left-pull-poses right-pull-poses joint-name environment-name)
  "Pull a container open by its handle, so many metres. Poses of the arm that is not used are nil."
  (roslisp:ros-info (environment-manipulation open-container) "Opening ~a" joint-name)
  (move-container 'cpoe:container-opening-event arm gripper-opening distance left-reach-poses right-reach-poses
                  left-grasp-poses right-grasp-poses left-pull-poses right-pull-poses joint-name environment-name))

(cpl:def-cram-function close-container (arm gripper-opening distance left-reach-poses right-reach-poses left-grasp-poses right-grasp-poses
                                            left-push-poses right-push-poses joint-name environment-name)
  "Push a container shut by its handle, so many metres. Poses of the arm that is not used are nil."
  (roslisp:ros-info (environment-manipulation close-container) "Closing ~a" joint-name)
  (move-container 'cpoe:container-closing-event arm gripper-opening (- distance) left-reach-poses right-reach-poses
                  left-grasp-poses right-grasp-poses left-push-poses right-push-poses joint-name environment-name))
