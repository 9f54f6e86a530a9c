(defn red-arc []
  (top-level
    (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
      (pm-execute 'turtlesim-pen-control (desig:a motion (type setting-pen) (r 255) (g 0) (b 0) (width 3)))
      (pm-execute 'turtlesim-navigation (desig:a motion (type driving) (speed 2) (angle 1))))))
