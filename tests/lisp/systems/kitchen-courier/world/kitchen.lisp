;;;; Kitchens as data.

(in-package #:courier-world)

(defparameter *kitchens* '())

(defmacro define-kitchen (name (&key (size '(10 8))) &body furniture)
  "FURNITURE: (class name (x y) thing...) where a thing is a class, or (class name . initargs)."
  `(progn
     (setf (getf *kitchens* ',name)
           (lambda ()
             (setf (note 'size) ',size)
             ,@(loop for (class place (x y) . things) in furniture
                     collect `(add-object (make-instance ',class :name ',place :x ,x :y ,y))
                     collect `(when (typep (object-named ',place) 'openable)
                                (setf (open-p (object-named ',place)) t))
                     append (loop for thing in things
                                  for number from 1
                                  for (kind label . initargs) = (if (consp thing) thing (list thing))
                                  for own = (or label (intern (format nil "~A-~D" kind number)))
                                  collect `(add-object (make-instance ',kind :name ',own ,@initargs) :in ',place))
                     collect `(when (typep (object-named ',place) 'openable)
                                (setf (open-p (object-named ',place)) nil)))
             *world*))
     ',name))

(defun build-kitchen (name)
  (funcall (or (getf *kitchens* name) (error 'unknown-object :name name :suggestions (loop for (key) on *kitchens* by #'cddr collect key)))))

(define-kitchen breakfast (:size (12 8))
  (table-top table (2 2) (cup red-cup :clean nil) (bowl my-bowl :clean nil) (cereal flakes :weight 3/10))
  (fridge fridge (10 1) (milk old-milk :shelf-life 1))
  (cupboard cupboard (10 6) plate (cup blue-cup))
  (dishwasher dishwasher (6 6) (plate blue-plate :clean nil))
  (surface sink (5 1) (milk new-milk :weight 7/2)))

(define-kitchen empty ())
