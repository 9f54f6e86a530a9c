(require cramhy *)
(import math [atan2]
        cramhy [v-dist]
        .control-turtlesim [turtle-pose send-vel-cmd])

(defn pose-msg->transform [msg]
  "The transform from the turtle's own frame to the world, for the turtle's pose `msg'."
  (with-fields [x y theta] msg
    (make-transform
      (make-3d-vector x y 0)
      (axis-angle->quaternion (make-3d-vector 0 0 1) theta))))

(defn relative-angle-to [goal pose-msg]
  "The angle in radians by which a turtle at `pose-msg' must turn to face `goal', a 3d-vector."
  (setv seen-from-turtle (transform-point (transform-inv (pose-msg->transform pose-msg)) goal))
  (atan2 seen-from-turtle.y seen-from-turtle.x))

(defn calculate-angular-cmd [goal [ang-vel-factor 4]]
  "The angular velocity that turns the turtle from where it is now towards `goal'."
  (* ang-vel-factor (relative-angle-to goal turtle-pose.value)))

(defn move-to [goal [distance-threshold 0.1]]
  "Drive until the turtle is nearer to `goal' than the threshold; stop it in any case."
  (setv distance (fl-funcall (fn [pose] (v-dist (. (pose-msg->transform pose) translation) goal))
                             turtle-pose)
        reached (< distance distance-threshold))
  (try
    (pursue
      (wait-for reached)
      (while True
        (send-vel-cmd 1.5 (calculate-angular-cmd goal 8))
        (wait-duration 0.1)))
    (finally
      (send-vel-cmd 0 0))))

(defn rotate-to [goal [threshold 0.05]]
  "Turn on the spot until the turtle faces `goal' within the threshold; stop it in any case."
  (setv angle (fl-funcall (fn [pose] (abs (relative-angle-to goal pose)))
                          turtle-pose)
        reached (< angle threshold))
  (try
    (pursue
      (wait-for reached)
      (while True
        (send-vel-cmd 0 (calculate-angular-cmd goal))
        (wait-duration 0.01)))
    (finally
      (send-vel-cmd 0 0))))
