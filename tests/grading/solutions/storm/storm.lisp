(in-package :tut)

(defun off-line (pose begin end)
  "How far a turtle is from the line from begin to end, both (x y), in metres."
  (with-fields (x y) pose
    (destructuring-bind ((x1 y1) (x2 y2)) (list begin end)
      (let ((length (sqrt (+ (expt (- x2 x1) 2) (expt (- y2 y1) 2)))))
        (abs (/ (- (* (- x2 x1) (- y y1)) (* (- y2 y1) (- x x1))) length))))))

(defun pen (off)
  (call-set-pen 255 255 255 3 off))

(define-condition blown-away (simple-plan-failure) ())

(defun back-to (place)
  "Drive to the place, until the turtle stands still there: the command to stop may be lost, too."
  (loop
    (move-to (make-3d-vector (first place) (second place) 0) 0.08)
    (wait-duration 0.1)
    (with-fields (x y linear_velocity) (value *turtle-pose*)
      (when (and (< (abs (- x (first place))) 0.12)
                 (< (abs (- y (second place))) 0.12)
                 (= 0 linear_velocity))
        (return)))))

(defun draw-side (begin end)
  "Draw from where the turtle is to end. Blown off the line, come back without the pen and go on."
  (let ((last-place begin))
    (with-failure-handling
        ((blown-away (failure)
           (declare (ignore failure))
           (pen 1)
           (back-to last-place)
           (pen 0)
           (retry)))
      (rotate-to (make-3d-vector (first end) (second end) 0))
      (pursue
        (move-to (make-3d-vector (first end) (second end) 0))
        (loop do
          (with-fields (x y) (value *turtle-pose*)
            (if (> (off-line (value *turtle-pose*) begin end) 0.15)
                (progn
                  (pen 1)
                  (fail 'blown-away))
                (setf last-place (list x y))))
          (wait-duration 0.016))))))

(defun draw-square-in-storm (size)
  (top-level
    (with-fields (x y) (value *turtle-pose*)
      (let ((corners (list (list x y) (list (+ x size) y) (list (+ x size) (+ y size)) (list x (+ y size)) (list x y))))
        (loop for (begin end) on corners
              while end
              do (draw-side begin end))))))
