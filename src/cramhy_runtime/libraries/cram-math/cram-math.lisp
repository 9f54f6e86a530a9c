;;;; cram-math: matrices of double-floats, samples of distributions, polygons and angles, as CRAM's costmaps use them. Indices of matrices are
;;;; row and column, sizes are width and height. A vector is a matrix that is one element wide.

(defpackage #:cram-math
  (:use #:common-lisp)
  (:nicknames #:cma)
  (:export
   ;; samples
   #:sample #:sample-discrete #:sample-from-distribution-matrix #:invalid-probability-distribution
   ;; matrices
   #:double-matrix #:width #:height #:make-double-matrix #:make-double-vector #:double-vector-size #:fill-double-matrix
   #:double-matrix-from-array #:double-matrix-from-grid #:grid-from-double-matrix #:mref #:map-double-matrix #:map-double-matrix-into
   #:double-matrix-transpose #:double-matrix-product #:m.+ #:m.- #:m.* #:m./ #:m+ #:m- #:m* #:m/
   ;; functions
   #:determinant #:gauss #:average
   ;; geometry
   #:2d-point #:polygon #:point-in-polygon #:degrees->radians #:radians->degrees))

(in-package #:cram-math)

;;; ---------------------------------------------------------------------------------------------------------------- geometry

(defun degrees->radians (degrees)
  "An angle in radians, a double-float."
  (* degrees (/ pi 180)))

(defun radians->degrees (radians)
  "An angle in degrees, a double-float."
  (* radians (/ 180 pi)))

(defclass 2d-point ()
  ((x :initarg :x :reader x)
   (y :initarg :y :reader y))
  (:documentation "A point in the plane."))

(defclass polygon ()
  ((vertices :initarg :vertices :reader vertices :documentation "A vector of its corners, each a `2d-point', in their order."))
  (:documentation "A polygon in the plane."))

(defmethod initialize-instance :after ((polygon polygon) &key (vertices nil given))
  (unless given
    (error "A polygon needs its corners: (make-instance 'polygon :vertices (list point ...))."))
  (setf (slot-value polygon 'vertices) (coerce vertices 'vector)))

(defgeneric point-in-polygon (point polygon)
  (:documentation "Whether POINT is inside of POLYGON.")
  (:method ((point 2d-point) (polygon polygon))
    ;; A ray from the point to greater x crosses the border an odd number of times.
    (let* ((corners (vertices polygon)) (inside nil) (count (length corners)))
      (dotimes (index count inside)
        (let ((one (aref corners index)) (other (aref corners (mod (1- index) count))))
          (when (and (not (eq (> (y one) (y point)) (> (y other) (y point))))
                     (< (- (x point) (x one))
                        (/ (* (- (x other) (x one)) (- (y point) (y one))) (- (y other) (y one)))))
            (setf inside (not inside))))))))

;;; --------------------------------------------------------------------------------------------------------------- matrices

(deftype double-matrix () '(simple-array double-float (* *)))

(defun height (matrix) (array-dimension matrix 0))
(defun width (matrix) (array-dimension matrix 1))

(defun leaves (contents)
  "The numbers in CONTENTS, a list of lists, from left to right."
  (if (listp contents) (mapcan #'leaves contents) (list contents)))

(defun fill-double-matrix (matrix &key (initial-element nil given) initial-contents)
  "Put INITIAL-ELEMENT everywhere into MATRIX, or INITIAL-CONTENTS, a list of rows or of all its elements. Returns MATRIX."
  (check-type matrix double-matrix)
  (cond (initial-contents
         (loop for number in (leaves initial-contents) for index below (array-total-size matrix)
               do (setf (row-major-aref matrix index) (float number 1d0))))
        (given
         (dotimes (index (array-total-size matrix))
           (setf (row-major-aref matrix index) (float initial-element 1d0)))))
  matrix)

(defun make-double-matrix (width height &key initial-contents (initial-element 0.0d0))
  "A matrix of HEIGHT rows and WIDTH columns; INITIAL-CONTENTS is a list of rows or of all elements."
  (fill-double-matrix (make-array (list height width) :element-type 'double-float :initial-element (float initial-element 1d0))
                      :initial-contents initial-contents))

(defun make-double-vector (size &key initial-contents)
  "A matrix of SIZE rows and one column."
  (make-double-matrix 1 size :initial-contents initial-contents))

(defun double-vector-size (vector)
  "How many elements VECTOR has, a matrix of one column."
  (assert (= (width vector) 1) () "A vector is a matrix of one column, and this one has ~D." (width vector))
  (height vector))

(defun map-double-matrix-into (result function &rest matrices)
  "Put what FUNCTION makes of the elements of MATRICES at each place into RESULT, and return it."
  (dotimes (index (array-total-size result) result)
    (setf (row-major-aref result index)
          (float (apply function (mapcar (lambda (matrix) (row-major-aref matrix index)) matrices)) 1d0))))

(defun map-double-matrix (function &rest matrices)
  "A matrix of what FUNCTION makes of the elements of MATRICES at each place."
  (apply #'map-double-matrix-into (make-double-matrix (width (first matrices)) (height (first matrices))) function matrices))

(defun double-matrix-from-array (array &optional out)
  "A matrix with the elements of ARRAY, of one or two dimensions; one of one dimension becomes a vector. OUT: where to put them."
  (let ((matrix (or out
                    (ecase (array-rank array)
                      (1 (make-double-vector (array-dimension array 0)))
                      (2 (make-double-matrix (array-dimension array 1) (array-dimension array 0)))))))
    (dotimes (index (array-total-size array) matrix)
      (setf (row-major-aref matrix index) (float (row-major-aref array index) 1d0)))))

(defun double-matrix-from-grid (grid &optional out)
  "A matrix with the elements of GRID. Grids are arrays of two dimensions here."
  (double-matrix-from-array grid out))

(defun grid-from-double-matrix (matrix)
  "A new grid with the elements of MATRIX. Grids are arrays of two dimensions here."
  (map-double-matrix #'identity matrix))

(defun double-matrix-transpose (matrix &optional (out (make-double-matrix (height matrix) (width matrix))))
  "MATRIX with rows for columns, in OUT."
  (dotimes (row (height matrix) out)
    (dotimes (column (width matrix))
      (setf (aref out column row) (aref matrix row column)))))

(defun double-matrix-product (left right &optional (out (make-double-matrix (width right) (height left))))
  "The product of two matrices, in OUT; the width of LEFT must be the height of RIGHT."
  (unless (= (width left) (height right))
    (error "A matrix of ~D columns cannot be multiplied with one of ~D rows." (width left) (height right)))
  (dotimes (row (height left) out)
    (dotimes (column (width right))
      (setf (aref out row column)
            (loop for index below (width left) sum (* (aref left row index) (aref right index column)) of-type double-float)))))

(macrolet ((with-number (name operator)
             `(defun ,name (matrix number &optional (out (make-double-matrix (width matrix) (height matrix))))
                ,(format nil "The matrix of (~A element NUMBER) for each element of MATRIX, in OUT." operator)
                (map-double-matrix-into out (lambda (element) (,operator element number)) matrix)))
           (with-matrix (name operator)
             `(defun ,name (left right &optional (out (make-double-matrix (width left) (height right))))
                ,(format nil "The matrix of (~A l r) for the elements of LEFT and RIGHT at each place, in OUT." operator)
                (map-double-matrix-into out #',operator left right))))
  (with-number m.+ +)
  (with-number m.- -)
  (with-number m.* *)
  (with-number m./ /)
  (with-matrix m+ +)
  (with-matrix m- -)
  (with-matrix m* *)
  (with-matrix m/ /))

(defun eliminate (matrix right)
  "Gauss's elimination with the greatest pivots, of MATRIX and RIGHT beside it, both changed. The determinant of MATRIX."
  (let ((size (height matrix)) (determinant 1d0))
    (unless (= size (width matrix))
      (error "A matrix of ~D rows and ~D columns is not square." size (width matrix)))
    (flet ((swap (array a b)
             (dotimes (x (width array)) (rotatef (aref array a x) (aref array b x))))
           (scale (array y factor)
             (dotimes (x (width array)) (setf (aref array y x) (* factor (aref array y x)))))
           (subtract (array y factor from)
             (dotimes (x (width array)) (decf (aref array y x) (* factor (aref array from x))))))
      (dotimes (step size determinant)
        (let ((pivot step))
          (loop for y from step below size
                do (when (> (abs (aref matrix y step)) (abs (aref matrix pivot step))) (setf pivot y)))
          (when (zerop (aref matrix pivot step)) (return 0d0))
          (unless (= pivot step)
            (swap matrix pivot step)
            (swap right pivot step)
            (setf determinant (- determinant)))
          (let ((value (aref matrix step step)))
            (setf determinant (* determinant value))
            (scale matrix step (/ value))
            (scale right step (/ value)))
          (dotimes (y size)
            (unless (= y step)
              (let ((factor (aref matrix y step)))
                (subtract matrix y factor step)
                (subtract right y factor step)))))))))

(defun make-identity-matrix (size)
  "A square matrix with ones from its upper left to its lower right corner."
  (let ((matrix (make-double-matrix size size)))
    (dotimes (index size matrix) (setf (aref matrix index index) 1d0))))

(defun determinant (matrix)
  "The determinant of a square matrix."
  (eliminate (map-double-matrix #'identity matrix) (make-identity-matrix (height matrix))))

(defun invert-matrix (matrix)
  "Two values: the inverse of MATRIX and its determinant; a matrix that has no inverse is an error."
  (let* ((inverse (make-identity-matrix (height matrix)))
         (determinant (eliminate (map-double-matrix #'identity matrix) inverse)))
    (when (zerop determinant)
      (error "The matrix ~S has no inverse." matrix))
    (values inverse determinant)))

;;; ------------------------------------------------------------------------------------------------------------ distributions

(defun average (numbers)
  "The mean of a sequence of numbers."
  (/ (reduce #'+ numbers) (length numbers)))

(defun gauss (covariance mean)
  "A function of a vector: the density there of the normal distribution with this matrix of covariances and this mean, a vector."
  (multiple-value-bind (inverse determinant) (invert-matrix covariance)
    (let* ((size (double-vector-size mean))
           (factor (/ (* (expt (* 2 pi) (/ size 2)) (sqrt determinant)))))
      (lambda (point)
        (let ((offset (m- point mean (make-double-vector size))))
          (* factor (exp (* -0.5 (aref (double-matrix-product (double-matrix-transpose offset) (double-matrix-product inverse offset))
                                       0 0)))))))))

(define-condition invalid-probability-distribution (error) ()
  (:report "The probabilities are 0 everywhere, so that nothing can be drawn from them.")
  (:documentation "A distribution whose sum is 0."))

(defun sample (variable probability &optional (max-retries 10000000))
  "What VARIABLE, a function of a number from 0 to 1, gives for a random one, as often as PROBABILITY, a function of it, says, from 0 to 1."
  (loop repeat max-retries
        for drawn = (funcall variable (random 1.0d0))
        when (<= (random 1.0d0) (funcall probability drawn)) do (return-from sample drawn))
  (error "No sample was drawn in ~D trials: the probabilities are too small." max-retries))

(defun sample-discrete (values-and-probabilities)
  "A value of the list ((value . probability) ...) that is drawn by lot."
  (let ((pairs (coerce values-and-probabilities 'vector)))
    (car (sample (lambda (number) (aref pairs (truncate (* number (length pairs))))) #'cdr))))

(defun sample-from-distribution-matrix (matrix)
  "The list (column row) of an element of MATRIX that is drawn by lot; its value is its chance against the others.
No element may be negative. A matrix of zeros is an error."
  (let* ((sum (loop for index below (array-total-size matrix) sum (row-major-aref matrix index)))
         (left (* (random 1d0) sum)) (drawn nil))
    (unless (plusp sum)
      (error 'invalid-probability-distribution))
    (dotimes (index (array-total-size matrix))
      (let ((weight (row-major-aref matrix index)))
        (when (plusp weight)
          (setf drawn index)
          (when (< left weight) (return))
          (decf left weight))))
    (multiple-value-bind (row column) (floor drawn (width matrix))
      (list column row))))
