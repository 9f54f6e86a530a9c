(defun two-places ()
  (top-level
    (with-process-modules-running (turtlesim-navigation)
      (let ((?place (desig:a location (horizontal-position :left) (vertical-position :top))))
        (pm-execute 'turtlesim-navigation (desig:a motion (type going-to) (goal ?place))))
      (let ((?place (desig:a location (horizontal-position :right) (vertical-position :bottom))))
        (pm-execute 'turtlesim-navigation (desig:a motion (type going-to) (goal ?place)))))))
