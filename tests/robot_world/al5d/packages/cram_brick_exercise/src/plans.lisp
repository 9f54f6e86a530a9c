(in-package :bex)

(def-process-module brick-arm (motion)
  (destructuring-bind (command argument) (reference motion)
    (ecase command
      (go-to-pose (go-to-pose argument))
      (close-to (close-to argument)))))

(defun above (pose height)
  (make-pose (v+ (origin pose) (make-3d-vector 0 0 (+ 0.086 height))) (orientation pose)))

(defun hand (?width)
  (exe:perform (a motion (type closing) (distance ?width))))

(defun arm (pose height)
  (let ((?goal (above pose height)))
    (exe:perform (a motion (type going) (target ?goal)))))

(defun carry (from to)
  (hand 0.03)
  (arm from 0.03)
  (arm from 0.005)
  (hand 0.0)
  (arm from 0.03)
  (arm to 0.03)
  (arm to 0.005)
  (hand 0.03)
  (arm to 0.03))

(defun touring ()
  (loop for ?corner in '(1 2)
        do (loop for place = (a location (corner ?corner)) then (next-solution place)
                 while place
                 do (let ((?goal (reference place)))
                      (exe:perform (a motion (type going) (target ?goal)))))))

(defun perform-with-arm (designator)
  (top-level
    (with-process-modules-running (brick-arm)
      (exe:perform designator))))
