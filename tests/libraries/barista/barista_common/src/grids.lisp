(in-package :barista-common)

(deftype value-array () '(simple-array double-float (* *)))

(define-condition out-of-grid (error)
  ((index :initarg :index :reader out-of-grid-index)
   (grid :initarg :grid :reader out-of-grid-grid))
  (:report (lambda (condition stream)
             (with-slots (index grid) condition
               (format stream "~s is not in a grid of ~d by ~d cells." index (grid-columns grid) (grid-rows grid))))))

(defclass grid ()
  ((width :initarg :width :reader grid-width :type real :documentation "in metres")
   (height :initarg :height :reader grid-height :type real)
   (resolution :initarg :resolution :reader grid-resolution :initform 0.1d0)
   (origin :initarg :origin :accessor grid-origin :initform (make-position 0 0))
   (values :type value-array)
   (evaluations :allocation :class :initform 0 :accessor grid-evaluations))
  (:documentation "Numbers for the cells of a rectangle on the floor."))

(defgeneric grid-columns (grid)
  (:method ((grid grid)) (values (round (grid-width grid) (grid-resolution grid)))))

(defgeneric grid-rows (grid)
  (:method ((grid grid)) (values (round (grid-height grid) (grid-resolution grid)))))

(defmethod initialize-instance :after ((grid grid) &key (initial-element 0.0d0))
  (setf (slot-value grid 'values)
        (make-array (list (grid-rows grid) (grid-columns grid))
                    :element-type 'double-float :initial-element (float initial-element 0d0))))

(defmethod slot-unbound (class (grid grid) (slot (eql 'origin)))
  (declare (ignore class))
  (setf (grid-origin grid) (make-position 0 0)))

(defmethod print-object ((grid grid) stream)
  (print-unreadable-object (grid stream :type t)
    (format stream "~dx~d" (grid-columns grid) (grid-rows grid))))

(defun make-grid (width height &rest arguments &key &allow-other-keys)
  (apply #'make-instance 'grid :width width :height height arguments))

(defun grid-index (grid x y)
  "Row and column of the place X, Y; OUT-OF-GRID, with the restarts USE-VALUE and CLIP, if it is outside."
  (let ((row (floor (- y (position-y (grid-origin grid))) (grid-resolution grid)))
        (column (floor (- x (position-x (grid-origin grid))) (grid-resolution grid))))
    (if (array-in-bounds-p (slot-value grid 'values) row column)
        (values row column)
        (restart-case (error 'out-of-grid :index (list x y) :grid grid)
          (clip ()
            :report "Take the nearest cell."
            (values (clamp row 0 (1- (grid-rows grid))) (clamp column 0 (1- (grid-columns grid)))))
          (use-value (row column)
            :report "Give the row and the column."
            :interactive (lambda () (list 0 0))
            (values row column))))))

(defun grid-cell (grid x y)
  (multiple-value-bind (row column) (grid-index grid x y)
    (aref (slot-value grid 'values) row column)))

(defun (setf grid-cell) (value grid x y)
  (multiple-value-bind (row column) (grid-index grid x y)
    (setf (aref (slot-value grid 'values) row column) (float value 0d0))))

(defmacro do-grid ((x y value grid &optional result) &body body)
  "Run BODY for the middle of each cell, row by row. VALUE is a place."
  (with-gensyms (array row column origin resolution)
    (once-only (grid)
      `(let ((,array (slot-value ,grid 'values))
             (,origin (grid-origin ,grid))
             (,resolution (grid-resolution ,grid)))
         (declare (type value-array ,array))
         (dotimes (,row (array-dimension ,array 0) ,result)
           (dotimes (,column (array-dimension ,array 1))
             (let ((,x (+ (position-x ,origin) (* ,resolution (+ ,column 1/2))))
                   (,y (+ (position-y ,origin) (* ,resolution (+ ,row 1/2)))))
               (declare (ignorable ,x ,y))
               (symbol-macrolet ((,value (aref ,array ,row ,column)))
                 ,@body))))))))

(defun fill-grid (grid function)
  "Set each cell to what FUNCTION gives for the x and y of its middle."
  (do-grid (x y value grid grid)
    (incf (grid-evaluations grid))
    (setf value (float (funcall function x y) 0d0))))

(defun map-grid (function grid &rest more)
  "A new grid: FUNCTION of the cells of GRID and of those of MORE, which have the same size."
  (let ((result (make-instance 'grid :width (grid-width grid) :height (grid-height grid)
                                     :resolution (grid-resolution grid) :origin (copy-position (grid-origin grid)))))
    (loop with target = (slot-value result 'values)
          with sources = (mapcar (lambda (each) (slot-value each 'values)) (cons grid more))
          for index from 0 below (array-total-size target)
          do (setf (row-major-aref target index)
                   (float (apply function (mapcar (lambda (source) (row-major-aref source index)) sources)) 0d0)))
    result))

(defun grid-sum (grid)
  (let ((sum 0d0))
    (declare (type double-float sum))
    (do-grid (x y value grid sum)
      (incf sum value))))

(defun grid-maximum (grid)
  (loop with array of-type value-array = (slot-value grid 'values)
        for index below (array-total-size array)
        maximize (row-major-aref array index)))

(defun normalize-grid (grid)
  (let ((sum (grid-sum grid)))
    (if (plusp sum)
        (map-grid (lambda (value) (/ value sum)) grid)
        (error "The cells of ~a are all zero." grid))))

(defgeneric combine-grids (how first second)
  (:method ((how (eql :multiply)) (first grid) (second grid)) (map-grid #'* first second))
  (:method ((how (eql :most)) first second) (map-grid #'max first second))
  (:method ((how function) first second) (map-grid how first second))
  (:method :around (how (first grid) (second grid))
    (assert (and (= (grid-columns first) (grid-columns second)) (= (grid-rows first) (grid-rows second))) (second)
            "The grids ~a and ~a are not of one size." first second)
    (call-next-method)))

(defstruct (cell (:type vector) :named (:constructor make-cell (x y value)))
  x y value)

(defun best-cells (grid count)
  "The COUNT cells with the greatest values, these first; of equal ones the first row's."
  (let ((cells '()))
    (do-grid (x y value grid)
      (when (plusp value) (push (make-cell x y value) cells)))
    (loop for cell in (stable-sort (nreverse cells) #'> :key #'cell-value)
          repeat count
          collect cell)))

(defun grid->list (grid)
  (loop with array = (slot-value grid 'values)
        for row from (1- (array-dimension array 0)) downto 0
        collect (loop for column from 0 to (1- (array-dimension array 1))
                      collect (aref array row column))))
