(in-package :barista-costmap)

(defun < (&rest numbers) (apply #'cl:< numbers))
(defun > (first &rest numbers)
  (declare (dynamic-extent numbers))
  (apply #'cl:> first numbers))

(define-condition no-functions (error)
  ((costmap :initarg :costmap :reader no-functions-costmap))
  (:report "The costmap has no functions yet."))

(defclass named-function ()
  ((name :initarg :name :reader function-name)
   (function :initarg :function :accessor function-of))
  (:metaclass standard-class))

(defgeneric function-score (name)
  (:documentation "Functions with a great score are called first: what they make zero is looked at no more.")
  (:method ((name symbol)) 1)
  (:method ((name named-function)) (function-score (function-name name))))

(defclass costmap (grid)
  ((functions :initarg :functions :initform nil :accessor costmap-functions)
   (filled :initform nil))
  (:default-initargs :width 4 :height 4 :resolution 1/2))

(defun make-costmap (&rest arguments)
  (apply 'make-instance 'costmap arguments))

(defmethod shared-initialize :after ((map costmap) slot-names &key center)
  (declare (ignore slot-names))
  (when center
    (with-accessors ((x cl-transforms:x) (y cl-transforms:y)) center
      (setf (bc:grid-origin map)
            (make-position (- x (/ (bc:grid-width map) 2)) (- y (/ (bc:grid-height map) 2)))))))

(defmethod print-object :around ((map costmap) stream)
  (if *print-readably*
      (error 'print-not-readable :object map)
      (call-next-method)))

(defgeneric register-function (costmap function &optional name)
  (:argument-precedence-order function costmap)
  (:method ((costmap costmap) (function named-function) &optional name)
    (declare (ignore name))
    (setf (slot-value costmap 'filled) nil)
    (push function (costmap-functions costmap)))
  (:method ((costmap costmap) (function function) &optional (name (gensym "F")))
    (register-function costmap (make-instance 'named-function :name name :function function)))
  (:method (costmap (function symbol) &optional (name function))
    (register-function costmap (fdefinition function) name)))

(defmacro define-cost-function (name (x y &rest parameters) (&key (score 1)) &body body)
  "A function of PARAMETERS that makes a cost function of X and Y, called NAME, with a SCORE."
  (let ((documentation (when (and (stringp (first body)) (rest body)) (list (pop body)))))
    `(progn
       (defmethod function-score ((name (eql ',name))) ,score)
       (defun ,name ,parameters
         ,@documentation
         (make-instance 'named-function
           :name ',name
           :function (lambda (,x ,y) (declare (ignorable ,x ,y)) ,@body))))))

(defun sorted-functions (costmap)
  (sort (copy-list (costmap-functions costmap)) #'cl:> :key #'function-score))

(defgeneric costmap-values (costmap)
  (:documentation "The grid of COSTMAP, computed.")
  (:method ((costmap costmap))
    (let ((functions (mapcar #'function-of (or (sorted-functions costmap) (error 'no-functions :costmap costmap)))))
      (bc:fill-grid costmap
                    (lambda (x y)
                      (loop with product = 1.0d0
                            for function in functions
                            for value = (funcall function x y)
                            when (zerop value) return 0.0d0
                            do (setf product (* product value))
                            finally (return product)))))))

(defmethod costmap-values :around ((costmap costmap))
  (with-slots (filled) costmap
    (unless filled
      (call-next-method)
      (when (zerop (bc:grid-maximum costmap))
        (warn "No place fits ~a." costmap))
      (setf filled t))
    costmap))

(defun merge-costmaps (first &rest others)
  (let* ((all (append (force-ll first) others))
         (result (make-instance 'costmap
                   :width (bc:grid-width (car all)) :height (bc:grid-height (car all))
                   :resolution (bc:grid-resolution (car all)) :origin (bc:grid-origin (car all)))))
    (dolist (each all result)
      (dolist (function (reverse (costmap-functions each)))
        (register-function result function)))))

(defvar *sampling-function* (lambda (limit) (random limit)))

(defun sample-place (costmap)
  "A place of COSTMAP, the likelier the greater its value."
  (costmap-values costmap)
  (let ((rest (funcall *sampling-function* (bc:grid-sum costmap))))
    (do-grid (x y value costmap)
      (when (cl:< 0 value)
        (when (<= (decf rest value) 0)
          (return-from sample-place (make-3d-vector x y 0)))))))

(defun sample-places (costmap)
  (lazy-list () (cont (sample-place costmap))))
