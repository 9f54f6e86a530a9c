(require cramhy *)
(in-package :tut)

(def-process-module turtlesim-navigation (motion-designator)
  (roslisp:ros-info (turtle-process-modules)
    "TurtleSim navigation invoked with motion designator `~a'."
    motion-designator)
  (destructuring-bind (command motion) (reference motion-designator)
    (ecase command
      (drive
        (send-vel-cmd
          (turtle-motion-speed motion)
          (turtle-motion-angle motion)))
      (move
        (move-to motion))
      (go-to
        (let ((point (reference motion)))
          (roslisp:ros-info (turtle-process-modules)
            "Goint to point ~a."
            point)
          (move-to point))))))

(def-process-module turtlesim-pen-control (motion-designator)
  (roslisp:ros-info (turtle-process-modules)
    "TurtleSim pen control invoked with motion designator `~a'."
    motion-designator)
  (destructuring-bind (command motion) (reference motion-designator)
    (ecase command
      (set-pen
        (call-set-pen
          (pen-motion-r motion)
          (pen-motion-g motion)
          (pen-motion-b motion)
          (pen-motion-width motion)
          (pen-motion-off motion))))))

(defun drive (?speed ?angle)
  (top-level
    (with-process-modules-running (turtlesim-navigation)
      (let ((trajectory (desig:a motion (type driving) (speed ?speed) (angle ?angle))))
        (pm-execute 'turtlesim-navigation trajectory)))))

(defun move-simple (?x ?y)
  "One motion: to the point (?x ?y)."
  (top-level
    (with-process-modules-running (turtlesim-navigation)
      (let ((goal (desig:a motion (type moving) (goal (?x ?y 0)))))
        (pm-execute 'turtlesim-navigation goal)))))

(defun move-parallel ()
  "Two motions for one module at once: the second waits until the first is done."
  (top-level
    (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
      (let ((goal (desig:a motion (type moving) (goal (9 1 0))))
            (trajectory (desig:a motion (type driving) (speed 3) (angle 8))))
        (cpl:par
          (pm-execute 'turtlesim-navigation goal)
          (pm-execute 'turtlesim-navigation trajectory))))))

(defun drive-n-draw (?x ?y)
  "Two modules at once: the turtle moves while its pen changes twice a second."
  (top-level
    (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
      (let ((goal (desig:a motion (type moving) (goal (?x ?y 0)))))
        (cpl:par
          (pm-execute 'turtlesim-navigation goal)
          (dotimes (i 10)
            (pm-execute 'turtlesim-pen-control
              (let ((?r (random 255))
                    (?g (random 255))
                    (?b (random 255))
                    (?width (+ 3 (random 5))))
                (desig:a motion (type setting-pen) (r ?r) (g ?g) (b ?b) (width ?width))))
            (sleep 0.5)))))))

(defun goto-location (?horizontal-position ?vertical-position)
  "To a place in a third of the world: :left :center :right and :bottom :center :top."
  (init)
  (top-level
    (with-process-modules-running (turtlesim-navigation)
      (with-retry-counters ((other-points 3))
        (with-failure-handling
            ((designator-error (failure)
               (declare (ignore failure))
               ;; chance may have put all points too near to a wall
               (do-retry other-points
                 (retry))))
          (let* ((?place (desig:a location
                           (horizontal-position ?horizontal-position)
                           (vertical-position ?vertical-position)))
                 (motion (desig:a motion (type going-to) (goal ?place))))
            (pm-execute 'turtlesim-navigation motion)))))))

(defun init ()
  "Starts a ROS node and listens to the turtle."
  (start-ros-node "turtle1")
  (init-ros-turtle "turtle1"))
