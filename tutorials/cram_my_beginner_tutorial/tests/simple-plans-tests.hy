(require cramhy *)
(in-package :tut-tests)

(defun turtle-at (x y theta)
  "The message that a turtle at (x, y) sends, its head turned by theta radians from the x axis."
  (make-message "turtlesim/Pose" :x x :y y :theta theta))

(defun angle-to (x y pose-msg)
  "The angle by which the turtle at `pose-msg' must turn to face (x, y)."
  (relative-angle-to (make-3d-vector x y 0) pose-msg))

(define-test relative-angle-to-dont-turn
  "A goal straight ahead: to the right, upwards, to the left, and across."
  (assert-number-equal 0 (angle-to 7 1 (turtle-at 1 1 0.0)))
  (assert-number-equal 0 (angle-to 1 7 (turtle-at 1 1 (/ pi 2))))
  (assert-number-equal 0 (angle-to 1 7 (turtle-at 7 7 pi)))
  (assert-number-equal 0 (angle-to 7 7 (turtle-at 1 1 (/ pi 4)))))

(define-test relative-angle-to-look-back
  "A goal behind the turtle: half a turn, to the left or to the right."
  (assert-number-equal pi (abs (angle-to 1 7 (turtle-at 7 7 0.0))))
  (assert-number-equal pi (abs (angle-to 1 1 (turtle-at 1 7 (/ pi 2)))))
  (assert-number-equal pi (abs (angle-to 1 1 (turtle-at 7 7 (/ pi 4))))))

(define-test relative-angle-to-type-error
  "A goal is a vector, and no pose."
  (assert-error 'type-error
                (relative-angle-to (turtle-at 7 1 0.0) (turtle-at 1 1 0.0))))
