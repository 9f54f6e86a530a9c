(require cramhy *)
(import .control-turtlesim [turtle-pose send-vel-cmd]
        .simple-plans [rotate-to]
        .location-designators [min-bound max-bound within-bounds-p]
        .conditions [OutOfBoundsError]
        . [action-designators selecting-process-modules])

(def-cram-function draw-house []
  "Draws a house; its lower left corner is where the turtle is."
  (with-fields [x y] turtle-pose.value
    ;; the walls
    (exe:perform (desig:an action (type drawing) (shape rectangle) (width 5) (height 4.5)))
    ;; the door
    (navigate-without-pen [(+ x 3) y 0])
    (exe:perform (desig:an action (type drawing) (shape rectangle) (width 1) (height 2.5)))
    ;; the window
    (navigate-without-pen [(+ x 0.5) (+ y 2) 0])
    (exe:perform (desig:an action (type drawing) (shape rectangle) (width 1) (height 1)))
    ;; the roof
    (navigate-without-pen [x (+ y 4.5) 0])
    (exe:perform (desig:an action (type drawing) (shape triangle) (base-width 5) (height 4)))))

(def-cram-function draw-simple-shape [vertices]
  "Draws lines from the turtle's position to the first of the points `vertices', and on to the others."
  (for [?vertex vertices]
    (exe:perform (desig:an action (type navigating) (target ?vertex)))))

(defn navigate-without-pen [?target]
  "Navigates to the point `?target' without a trace."
  (exe:perform (desig:a motion (type setting-pen) (off 1)))
  (exe:perform (desig:an action (type navigating) (target ?target)))
  (exe:perform (desig:a motion (type setting-pen) (off 0))))

(defn out-of-bounds-p [pose-msg]
  "Whether a turtle at `pose-msg' is too near to a wall."
  (not (within-bounds-p pose-msg.x pose-msg.y)))

(defn clamp [coordinate]
  "The number nearest to `coordinate' that is inside of the bounds, and 0.1 away from them."
  (max (+ min-bound 0.1) (min coordinate (- max-bound 0.1))))

(def-cram-function navigate [?v]
  "Moves to the point `?v', a list [x y z]. A turtle that gets too near to a wall turns back, and goes
  to the nearest point to the target that is inside of the bounds."
  (with-failure-handling
      [[OutOfBoundsError [failure]
         (ros-warn (draw-simple-simple) "Moving went-wrong: ~a" failure)
         (exe:perform (desig:a motion (type setting-pen) (r 204) (g 0) (b 0) (width 2)))
         (let [[x y z] ?v
               ?inside [(clamp x) (clamp y) z]]
           (recover-from-oob (make-3d-vector #* ?inside))
           (exe:perform (desig:a motion (type moving) (goal ?inside))))
         (exe:perform (desig:a motion (type setting-pen) (off 0)))
         (leave None)]]
    (pursue
      (seq
        (wait-for (fl-funcall out-of-bounds-p turtle-pose))
        (fail (OutOfBoundsError)))
      (exe:perform (desig:a motion (type moving) (goal ?v))))))

(defn recover-from-oob [[goal None]]
  "Turns towards the middle of the world, drives a little, and turns to `goal' if there is one."
  (rotate-to (make-3d-vector 5.5 5.5 0))
  (send-vel-cmd 1 0)
  (wait-duration 0.2)
  (when goal
    (rotate-to goal)))

(defn perform-draw-house []
  "Draws a house in the middle of the world."
  (top-level
    (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
      (navigate-without-pen [3 2 0])
      (exe:perform (desig:an action (type drawing) (shape house))))))
