(require cramhy *)
(in-package :kitchen)

(defun radians (degrees)
  (* degrees (/ pi 180)))

(defun pose (x y z &optional (degrees 0) (frame "map"))
  "The pose at (x, y, z) metres, turned about the vertical axis by `degrees'."
  (cl-transforms-stamped:make-pose-stamped
   frame 0.0
   (cl-transforms:make-3d-vector x y z)
   (cl-transforms:axis-angle->quaternion
    (cl-transforms:make-3d-vector 0 0 1) (radians degrees))))

(def-fact-group costmap-metadata (costmap:costmap-size costmap:costmap-origin costmap:costmap-resolution
                                  costmap:costmap-padding costmap:costmap-manipulation-padding
                                  costmap:costmap-in-reach-distance costmap:costmap-reach-minimal-distance
                                  costmap:visibility-costmap-size costmap:orientation-samples
                                  costmap:orientation-sample-step)
  ;; the maps from which places are drawn cover the kitchen; lengths are metres
  (<- (costmap:costmap-size 12 12))
  (<- (costmap:costmap-origin -6 -6))
  (<- (costmap:costmap-resolution 0.05))
  (<- (costmap:costmap-padding 0.3))
  (<- (costmap:costmap-manipulation-padding 0.4))
  (<- (costmap:costmap-in-reach-distance 0.9))
  (<- (costmap:costmap-reach-minimal-distance 0.2))
  (<- (costmap:visibility-costmap-size 2))
  (<- (costmap:orientation-samples 2))
  (<- (costmap:orientation-sample-step 0.1)))

(defun init-kitchen ()
  "Puts the robot into a kitchen without anything in it. `startup-ros' calls it."
  (setf btr-belief:*robot-parameter* "robot_description"
        btr-belief:*kitchen-parameter* "kitchen_description")
  (coe:clear-belief)
  (values))

(roslisp-utilities:register-ros-init-function init-kitchen)

(defun spawn (name type pose)
  "Puts a thing of a type such as :bottle into the kitchen, and lets it fall until it stands."
  (btr-utils:spawn-object name type :pose pose)
  (btr:simulate btr:*current-bullet-world* 100)
  name)

(defun place-of (name)
  "Where a thing is: x, y and z in whole centimetres."
  (let ((origin (cl-transforms:origin (btr:pose (btr:object btr:*current-bullet-world* name)))))
    (flet ((centimetres (coordinate)
             (/ (round (* 100 coordinate)) 100.0)))
      (list (centimetres (cl-transforms:x origin))
            (centimetres (cl-transforms:y origin))
            (centimetres (cl-transforms:z origin))))))

(defun things ()
  "Each thing in the kitchen, and where it is."
  (loop for thing in (btr:objects btr:*current-bullet-world*)
        when (and (typep thing 'btr:item) (btr:item-types thing))
          collect (cons (btr:name thing) (place-of (btr:name thing)))))

(defun held ()
  "The names of the things that the robot holds."
  (mapcar #'first (btr:attached-objects (btr:get-robot-object))))
