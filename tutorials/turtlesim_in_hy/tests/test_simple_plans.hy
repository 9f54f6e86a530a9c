(require cramhy *)
(import math [pi]
        pytest [approx raises]
        cramhy_runtime.lisp_core.condition_types [TypeError_ :as LispTypeError]
        ..simple-plans [relative-angle-to])

(defn turtle-at [x y theta]
  "The message that a turtle at (x, y) sends, its head turned by theta radians from the x axis."
  (make-message "turtlesim/Pose" :x x :y y :theta theta))

(defn angle-to [x y pose-msg]
  "The angle by which the turtle at `pose-msg' must turn to face (x, y)."
  (relative-angle-to (make-3d-vector x y 0) pose-msg))

(defn about [number]
  (approx number :abs 1e-5))

(defn test-relative-angle-to-dont-turn []
  "A goal straight ahead: to the right, upwards, to the left, and across."
  (assert (= (about 0) (angle-to 7 1 (turtle-at 1 1 0.0))))
  (assert (= (about 0) (angle-to 1 7 (turtle-at 1 1 (/ pi 2)))))
  (assert (= (about 0) (angle-to 1 7 (turtle-at 7 7 pi))))
  (assert (= (about 0) (angle-to 7 7 (turtle-at 1 1 (/ pi 4))))))

(defn test-relative-angle-to-look-back []
  "A goal behind the turtle: half a turn, to the left or to the right."
  (assert (= (about pi) (abs (angle-to 1 7 (turtle-at 7 7 0.0)))))
  (assert (= (about pi) (abs (angle-to 1 1 (turtle-at 1 7 (/ pi 2))))))
  (assert (= (about pi) (abs (angle-to 1 1 (turtle-at 7 7 (/ pi 4)))))))

(defn test-relative-angle-to-type-error []
  "A goal is a vector, and no pose."
  (with [_ (raises LispTypeError)]
    (relative-angle-to (turtle-at 7 1 0.0) (turtle-at 1 1 0.0))))
