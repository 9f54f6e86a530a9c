;;;; The plan that README shows: cramhy run tutorials/spiral.lisp --seed 3 --picture spiral.replay.svg

(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)
(in-package :tut)
(init) ; a ROS node, which listens to the turtle

(defun turtle-x ()
  "A fluent whose value is how far to the right the turtle is."
  (fl-funcall #'turtlesim-msg:x *turtle-pose*))

(defun drive-in-a-spiral ()
  "Drive on a curve, faster and faster, without end."
  (loop for speed from 1 by 0.15
        do (send-vel-cmd speed 1.5)
           (sleep 0.5)))

(defun change-colours ()
  "Give the pen a new colour every half second, without end."
  (loop (call-set-pen (random 255) (random 255) (random 255) 4 0)
        (sleep 0.5)))

(defun stop ()
  (send-vel-cmd 0 0))

(top-level
  (unwind-protect
       (pursue                          ; three branches, until the first one is done:
         (wait-for (> (turtle-x) 10))   ; the wall is near
         (drive-in-a-spiral)
         (change-colours))
    (stop)))                            ; whatever ends the plan, stop the turtle
