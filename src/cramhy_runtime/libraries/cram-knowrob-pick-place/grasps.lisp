;;;; Where the gripper takes hold of each kind of object, in metres from the origin of its frame.

(in-package #:cram-knowrob-pick-place)

(defvar *left-plate-rotation* '((0 1 0) (0.5 0 -0.866) (-0.866 0 -0.5))
  "A gripper that holds the rim of a plate on its left, tilted by 30 degrees.")

(defvar *right-plate-rotation* '((0 -1 0) (-0.5 0 0.866) (-0.866 0 -0.5))
  "The same on its right.")

(defmacro define-grasps (types arms &body rows)
  "Let grippers of ARMS grasp objects of TYPES as each of ROWS tells: GRASP, ROTATION, and four lists of metres, which are the place of the
gripper, and what is added to it before the grasp, shortly before it, and while lifting."
  `(progn
     ,@(loop for (grasp rotation translation pregrasp 2nd-pregrasp lift) in rows
             collect `(def-object-type-to-gripper-transforms ',types ',arms ,grasp
                        :grasp-translation ',translation
                        :grasp-rot-matrix ,rotation
                        :pregrasp-offsets ',pregrasp
                        :2nd-pregrasp-offsets ',2nd-pregrasp
                        :lift-offsets ',lift
                        :2nd-lift-offsets ',lift))))

(define-grasps (:cutlery :spoon :fork :knife) (:left :right)
  (:top *top-across-x-grasp-rotation* (0 0 0) (0 0 0.20) (0 0 0.20) (0 0 0.20)))

(define-grasps (:plate :tray) :left
  (:left-side *left-plate-rotation* (0 0.115 0.015) (0 0.2 0.15) (0 0.2 0.03) (0 0 0.15)))

(define-grasps :plate :right
  (:right-side *right-plate-rotation* (0 -0.115 0.015) (0 -0.2 0.15) (0 -0.2 0.03) (0 0 0.15)))

(define-grasps (:bottle :drink) (:left :right)
  (:left-side *left-side-grasp-rotation* (0 -0.02 0.005) (0 0.15 0.15) (0 0.15 0) (0 0 0.15))
  (:right-side *right-side-grasp-rotation* (0 0.02 0.005) (0 -0.15 0.15) (0 -0.15 0) (0 0 0.15))
  (:back *back-grasp-rotation* (0.02 0 0.005) (-0.15 0 0.15) (-0.15 0 0) (0 0 0.15))
  (:front *front-grasp-rotation* (-0.02 0 0.005) (0.15 0 0.15) (0.15 0 0) (0 0 0.15))) ; the original comes from the back, too

(define-grasps :cup (:left :right)
  (:back *back-grasp-rotation* (0.02 0 0.03) (-0.15 0 0.15) (-0.15 0 0) (0 0 0.15))
  (:front *front-grasp-rotation* (-0.02 0 0.03) (0.15 0 0.15) (0.15 0 0) (0 0 0.15))
  (:left-side *left-side-grasp-rotation* (0 -0.02 0.03) (0 0.15 0.15) (0 0.15 0) (0 0 0.15))
  (:right-side *right-side-grasp-rotation* (0 0.02 0.03) (0 -0.15 0.15) (0 -0.15 0) (0 0 0.15))
  (:top *top-across-y-grasp-rotation* (-0.03 0 0.02) (0 0 0.15) (0 0 0.15) (0 0 0.15)))

(define-grasps :milk (:left :right)
  (:back *back-grasp-rotation* (0.01 0 0) (-0.15 0 0.15) (-0.15 0 0) (0 0 0.15))
  (:front *front-grasp-rotation* (-0.01 0 0) (0.15 0 0.15) (0.15 0 0) (0 0 0.15))
  (:left-side *left-side-grasp-rotation* (0 -0.01 0) (0 0.15 0.15) (0 0.15 0) (0 0 0.15))
  (:right-side *right-side-grasp-rotation* (0 0.01 0) (0 -0.15 0.15) (0 -0.15 0) (0 0 0.15))
  (:top *top-across-x-grasp-rotation* (0 0 0.05) (0 0 0.15) (0 0 0.15) (0 0 0.15))) ; not in the original, for what stands among others

(define-grasps (:cereal :breakfast-cereal) (:left :right)
  (:back *back-grasp-rotation* (-0.03 0 0.04) (-0.15 0 0.15) (-0.15 0 0) (0 0 0.15))
  (:front *front-grasp-rotation* (0.03 0 0.04) (0.15 0 0.15) (0.15 0 0) (0 0 0.15))
  (:top *top-across-x-grasp-rotation* (0 0 0.04) (0 0 0.15) (0 0 0.15) (0 0 0.15)))

(define-grasps :bowl (:left :right)
  (:top *top-across-y-grasp-rotation* (-0.07 0 0.01) (0 0 0.20) (0 0 0.20) (0 0 0.20)))
