(require cramhy *)
(import random [randrange]
        cramhy_runtime.designators [DesignatorError]
        .control-turtlesim [send-vel-cmd call-set-pen init-ros-turtle]
        .simple-plans [move-to]
        . [motion-designators location-designators])

(def-process-module turtlesim-navigation [motion-designator]
  (roslisp:ros-info (turtle-process-modules)
    "TurtleSim navigation invoked with motion designator `~a'."
    motion-designator)
  (setv [command motion] (reference motion-designator))
  (match command
    "drive"
      (send-vel-cmd
        motion.speed
        motion.angle)
    "move"
      (move-to motion)
    "go-to"
      (let [point (reference motion)]
        (roslisp:ros-info (turtle-process-modules)
          "Goint to point ~a."
          point)
        (move-to point))))

(def-process-module turtlesim-pen-control [motion-designator]
  (roslisp:ros-info (turtle-process-modules)
    "TurtleSim pen control invoked with motion designator `~a'."
    motion-designator)
  (setv [command motion] (reference motion-designator))
  (match command
    "set-pen"
      (call-set-pen
        motion.r
        motion.g
        motion.b
        motion.width
        motion.off)))

(defn drive [?speed ?angle]
  (top-level
    (with-process-modules-running [turtlesim-navigation]
      (let [trajectory (desig:a motion (type driving) (speed ?speed) (angle ?angle))]
        (pm-execute 'turtlesim-navigation trajectory)))))

(defn move-simple [?x ?y]
  "One motion: to the point (?x ?y)."
  (top-level
    (with-process-modules-running [turtlesim-navigation]
      (let [goal (desig:a motion (type moving) (goal [?x ?y 0]))]
        (pm-execute 'turtlesim-navigation goal)))))

(defn move-parallel []
  "Two motions for one module at once: the second waits until the first is done."
  (top-level
    (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
      (let [goal (desig:a motion (type moving) (goal [9 1 0]))
            trajectory (desig:a motion (type driving) (speed 3) (angle 8))]
        (cpl:par
          (pm-execute 'turtlesim-navigation goal)
          (pm-execute 'turtlesim-navigation trajectory))))))

(defn drive-n-draw [?x ?y]
  "Two modules at once: the turtle moves while its pen changes twice a second."
  (top-level
    (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
      (let [goal (desig:a motion (type moving) (goal [?x ?y 0]))]
        (cpl:par
          (pm-execute 'turtlesim-navigation goal)
          (for [_ (range 10)]
            (pm-execute 'turtlesim-pen-control
              (let [?r (randrange 255)
                    ?g (randrange 255)
                    ?b (randrange 255)
                    ?width (randrange 3 8)]
                (desig:a motion (type setting-pen) (r ?r) (g ?g) (b ?b) (width ?width))))
            (sleep 0.5)))))))

(defn goto-location [?horizontal-position ?vertical-position]
  "To a place in a third of the world: left, center, right and bottom, center, top."
  (init)
  (top-level
    (with-process-modules-running [turtlesim-navigation]
      (with-retry-counters [[other-points 3]]
        (with-failure-handling
            [[DesignatorError [failure]
               ;; chance may have put all points too near to a wall
               (do-retry other-points
                 (retry))]]
          (let [?place (desig:a location
                         (horizontal-position ?horizontal-position)
                         (vertical-position ?vertical-position))
                motion (desig:a motion (type going-to) (goal ?place))]
            (pm-execute 'turtlesim-navigation motion)))))))

(defn init []
  "Starts a ROS node and listens to the turtle."
  (start-ros-node "turtle1")
  (init-ros-turtle "turtle1"))
