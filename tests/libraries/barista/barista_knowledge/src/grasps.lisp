(in-package :bk)

(defgeneric grasp-offset (kind grasp)
  (:documentation "The way from the middle of a thing of KIND to the hand, as a vector; NIL if it cannot be held so.")
  (:method (kind grasp) (declare (ignore kind grasp)) nil))

(defmacro def-grasps (kind &body rows)
  `(progn
     ,@(loop for (grasp x y z) in rows
             collect `(defmethod grasp-offset ((kind (eql ',kind)) (grasp (eql ,grasp)))
                        (cl-transforms:make-3d-vector ,x ,y ,z)))
     (pushnew ',kind (get 'grasp-offset :kinds))))

(def-grasps cup (:top 0 0 0.1) (:side -0.05 0 0))
(def-grasps mug (:handle 0 -0.06 0) (:top 0 0 0.12))
(def-grasps tray (:edges 0 0.2 0))

(defun calculate-grasp (thing grasp)
  (loop for class in (closer-classes (class-of thing))
        thereis (grasp-offset (class-name class) grasp)))

(defun closer-classes (class)
  "CLASS and those above it, as far as they are things."
  #+sbcl (remove-if-not (lambda (each) (subtypep each 'thing)) (sb-mop:class-precedence-list class))
  #-sbcl (labels ((up (name) (cons (find-class name) (mapcan #'up (copy-list (remove 'thing (cdr (assoc name *thing-types*))))))))
           (up (class-name class))))

(defun best-grasp (thing)
  (let ((found (loop for grasp in '(:handle :side :top :edges)
                     for offset = (calculate-grasp thing grasp)
                     when offset collect (cons grasp (cl-transforms:v-norm offset)))))
    (car (first (sort found #'< :key #'cdr)))))
