(defn colour-change []
  (top-level
    (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
      (let [goal (desig:a motion (type moving) (goal (8 5.5 0)))]
        (cpl:par
          (pm-execute 'turtlesim-navigation goal)
          (seq
            (pm-execute 'turtlesim-pen-control (desig:a motion (type setting-pen) (r 255) (g 0) (b 0) (width 3)))
            (sleep 1.5)
            (pm-execute 'turtlesim-pen-control (desig:a motion (type setting-pen) (r 0) (g 255) (b 0) (width 3)))))))))
