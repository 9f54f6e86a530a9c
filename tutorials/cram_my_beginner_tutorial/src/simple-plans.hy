(require cramhy *)
(in-package :tut)

(defun pose-msg->transform (msg)
  "The transform from the turtle's own frame to the world, for the turtle's pose `msg'."
  (with-fields (x y theta) msg
    (make-transform
      (make-3d-vector x y 0)
      (axis-angle->quaternion (make-3d-vector 0 0 1) theta))))

(defun relative-angle-to (goal pose-msg)
  "The angle in radians by which a turtle at `pose-msg' must turn to face `goal', a 3d-vector."
  (let ((seen-from-turtle (transform-point (transform-inv (pose-msg->transform pose-msg)) goal)))
    (atan (y seen-from-turtle) (x seen-from-turtle))))

(defun calculate-angular-cmd (goal &optional (ang-vel-factor 4))
  "The angular velocity that turns the turtle from where it is now towards `goal'."
  (* ang-vel-factor (relative-angle-to goal (value *turtle-pose*))))

(defun move-to (goal &optional (distance-threshold 0.1))
  "Drive until the turtle is nearer to `goal' than the threshold; stop it in any case."
  (let ((reached (< (fl-funcall #'v-dist
                                (fl-funcall #'translation
                                            (fl-funcall #'pose-msg->transform *turtle-pose*))
                                goal)
                    distance-threshold)))
    (unwind-protect
         (pursue
           (wait-for reached)
           (loop do
             (send-vel-cmd 1.5 (calculate-angular-cmd goal 8))
             (wait-duration 0.1)))
      (send-vel-cmd 0 0))))

(defun rotate-to (goal &optional (threshold 0.05))
  "Turn on the spot until the turtle faces `goal' within the threshold; stop it in any case."
  (let ((reached (< (fl-funcall #'abs
                                (fl-funcall #'relative-angle-to goal *turtle-pose*))
                    threshold)))
    (unwind-protect
         (pursue
           (wait-for reached)
           (loop do
             (send-vel-cmd 0 (calculate-angular-cmd goal))
             (wait-duration 0.01)))
      (send-vel-cmd 0 0))))
