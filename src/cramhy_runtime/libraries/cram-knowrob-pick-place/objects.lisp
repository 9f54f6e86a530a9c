;;;; Kinds of objects, and what a gripper needs to know of each.

(in-package #:cram-knowrob-pick-place)

(def-fact-group kitchen-objects (object-type-direct-subtype orientation-matters object-type-grasp)

  (<- (object-type-direct-subtype :container :drawer))
  (<- (object-type-direct-subtype :container :refrigerator))
  (<- (object-type-direct-subtype :refrigerator :fridge))

  (<- (orientation-matters ?type)
    (member ?type (:knife :fork :spoon :cutlery :spatula)))

  (<- (object-type-grasp ?type :top)
    (member ?type (:cutlery :spoon :fork :knife)))

  (<- (object-type-grasp ?type ?grasp)
    (member ?type (:plate :tray))
    (member ?grasp (:left-side :right-side)))

  (<- (object-type-grasp :bottle ?grasp)
    (member ?grasp (:left-side :right-side :back :front)))

  (<- (object-type-grasp :cup ?grasp)
    (member ?grasp (:back :front :left-side :right-side)))

  (<- (object-type-grasp :milk ?grasp)
    (member ?grasp (:back :left-side :right-side :front)))

  (<- (object-type-grasp ?type ?grasp)
    (member ?type (:cereal :breakfast-cereal))
    (member ?grasp (:back :front)))

  (<- (object-type-grasp :bowl :top)))

(defmacro define-figures (function default &body figures)
  "Let FUNCTION give a figure for types of objects: FIGURES are (FIGURE TYPE...), DEFAULT is that of all others."
  `(progn
     (defmethod ,function (object-type)
       (declare (ignore object-type))
       ,default)
     ,@(loop for (figure . types) in figures
             nconc (loop for type in types
                         collect `(defmethod ,function ((object-type (eql ,type))) ,figure)))))

(define-figures get-object-type-gripping-effort 35
  (100 :cutlery :spoon :fork :knife :plate :tray :bowl)
  (60 :bottle)
  (50 :cup)
  (20 :breakfast-cereal)
  (15 :milk :cereal))

(define-figures get-object-type-gripper-opening 0.10
  (0.04 :cutlery :spoon :fork :knife)
  (0.02 :plate :tray)
  (0.10 :container-prismatic))
