;;;; Pictures of a world and movies of what happens in it, without a window.

(in-package #:cram-bullet-reasoning)

(defun save-picture (path &key (world *current-bullet-world*) camera (width 640) (height 480))
  "Write a picture of WORLD to the PNG file PATH; returns PATH.
CAMERA: nil shows all of it, :ROBOT what the robot's camera sees, a string names another camera link of it; a pose looks along its z axis;
a list of two places, such as ((-3 -2 2) (0 0 1)), is the eye and where it looks."
  (robot-world:save-picture world path :camera camera :width width :height height))

(defmacro with-movie ((path &key camera (width 400) (height 300) (frames 900)) &body body)
  "The values of BODY; what happens meanwhile in the current world is written to the GIF file PATH, each motion for as long as it would take.
Also when BODY fails. CAMERA: as for `save-picture'; the one that does not move with the robot is the best. A run of more than FRAMES is
shown faster."
  (let ((movie (gensym "MOVIE")) (file (gensym "PATH")))
    `(let ((,file ,path))
       (robot-world:check-movie ,file)
       (let ((,movie (robot-world:begin-movie *current-bullet-world* :camera ,camera :width ,width :height ,height
                                                :frames ,frames)))
         (unwind-protect (progn ,@body)
           (robot-world:end-movie ,movie ,file))))))
