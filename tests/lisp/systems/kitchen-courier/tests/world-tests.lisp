(in-package #:kitchen-courier-tests)

(define-test geometry
  (assert-number-equal 5 (courier-world:distance (make-point 0 0) (make-point 3 4)))
  (assert-equal '(1/2 1) (let ((middle (courier-world:between (make-point 0 0) (make-point 1 2))))
                           (list (courier-world:point-x middle) (courier-world:point-y middle))))
  (assert-equalp (make-point 1 2) (courier-world:copy-point (make-point 1 2)))
  (assert-true (typep (courier-world:make-pose 0d0 0d0) 'courier-world:point))
  (assert-error 'type-error (courier-world:between (make-point 0 0) (make-point 1 2) 2)))

(define-test kitchens
  (in-kitchen ()
    (assert-eq 'table (courier-world:location-of 'courier-world:red-cup))
    (assert-equal '(courier-world:blue-cup courier-world:my-bowl courier-world:red-cup)
                  (mapcar #'courier-world:name (courier-world:objects-of 'courier-world:cup)))
    (assert-eql 3 (length (courier-world:holds (object-named 'table) 'courier-world:movable)))
    (assert-error 'courier-world:unknown-object (object-named 'sofa))
    (assert-false (object-named 'sofa nil))
    (assert-error 'courier-world:container-full
                  (let ((sink (object-named 'courier-world:sink)))
                    (dolist (name '(a b c d e f g))
                      (courier-world:add-object (make-instance 'courier-world:plate :name name) :in sink))))
    (assert-eql 6 (length (courier-world:contents (object-named 'courier-world:sink))))))

(define-test hazards
  (in-kitchen ()
    (assert-equal '(courier-world::heavy courier-world::closed courier-world::spills)
                  (sort-by-name (courier-world:hazards (object-named 'courier-world:fridge))
                                '(courier-world::heavy courier-world::closed courier-world::spills)))
    (assert-eql 2 (courier-world:weight (object-named 'courier-world:new-milk)))
    (assert-eql 61 (courier-world:total-weight (object-named 'courier-world:fridge)))))

(defun sort-by-name (symbols order)
  (sort (copy-list symbols) #'< :key (lambda (symbol) (position symbol order))))

(define-test costmaps
  (let ((map (courier-costmap:make-costmap 3 2 :function #'+)))
    (assert-equalp #2A((0 1 2) (1 2 3)) (courier-costmap:costmap-cells map))
    (incf (courier-costmap:cell map (make-point 2 1)) 10)
    (assert-equalp #(1 2 13) (courier-costmap:row map 1))
    (assert-equal 13 (nth-value 1 (courier-costmap:hottest map)))
    (assert-equal '((2 0) (1 1) (0 0)) (courier-costmap:neighbours map 1 0))
    (assert-number-equal 1 (let ((map (courier-costmap:normalize map)))
                             (reduce #'+ (make-array 6 :displaced-to (courier-costmap:costmap-cells map)))))
    (assert-prints " 1 .:@
 0 ..:
   012" (courier-costmap:draw (courier-costmap:make-costmap 3 2 :function (lambda (x y) (* x x (1+ y) (1+ y)))) :legend ".:-=+@"))))
