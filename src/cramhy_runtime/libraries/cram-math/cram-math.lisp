;;;; cram-math: angles, vectors and matrices of double-floats, distributions and colours, as robot plans use them. Indices of matrices are
;;;; row and column; vectors are one-dimensional arrays.

(defpackage #:cram-math
  (:use #:common-lisp)
  (:nicknames #:cma)
  (:export #:degrees->radians #:radians->degrees #:normalize-angle #:angle-difference #:square #:clamp #:linear-interpolation
           #:average #:mean #:variance #:standard-deviation #:covariance #:gauss #:sample-gauss #:2d-cov-ellipse
           #:double-vector #:make-double-vector #:double-vector-sum #:double-vector-difference #:double-vector-product
           #:scale-double-vector #:double-vector-norm
           #:double-matrix #:make-double-matrix #:make-identity-matrix #:copy-double-matrix #:height #:width #:map-double-matrix
           #:double-matrix-sum #:double-matrix-difference #:scale-double-matrix #:double-matrix-product #:double-matrix-transpose
           #:double-matrix-determinant #:invert-double-matrix #:normalize-double-matrix
           #:sample-from-distribution-matrix #:hsv->rgb #:rgb->hsv
           #:invalid-probability-distribution))

(in-package #:cram-math)

(defun degrees->radians (degrees)
  "An angle in radians, a double-float."
  (* degrees (/ pi 180)))

(defun radians->degrees (radians)
  "An angle in degrees, a double-float."
  (* radians (/ 180 pi)))

(defun normalize-angle (radians)
  "The same angle between -pi (exclusive) and pi."
  (let ((angle (mod radians (* 2 pi))))
    (if (> angle pi) (- angle (* 2 pi)) angle)))

(defun angle-difference (from to)
  "The angle by which one turns from FROM to TO, the shorter way: between -pi (exclusive) and pi."
  (normalize-angle (- to from)))

(defun square (number)
  (* number number))

(defun clamp (number low high)
  "NUMBER, or the nearer one of LOW and HIGH when it is not between them."
  (max low (min high number)))

(defun linear-interpolation (from to share)
  "The number between FROM (SHARE is 0) and TO (SHARE is 1)."
  (+ from (* share (- to from))))

(defun average (numbers &optional (other nil two-numbers-p))
  "The mean of a sequence of numbers; of two arguments, numbers, the one in the middle between them."
  (if two-numbers-p
      (+ numbers (/ (- other numbers) 2))
      (/ (reduce #'+ numbers) (length numbers))))

;;; --------------------------------------------------------------------------------------------------------------- matrices

(deftype double-vector (&optional (size '*)) `(simple-array double-float (,size)))
(deftype double-matrix (&optional (height '*) (width '*)) `(simple-array double-float (,height ,width)))

(defun make-double-vector (size &key (initial-element 0d0) initial-contents)
  (if initial-contents
      (map-into (make-array size :element-type 'double-float) (lambda (number) (float number 1d0)) initial-contents)
      (make-array size :element-type 'double-float :initial-element (float initial-element 1d0))))

(defun make-double-matrix (width height &key (initial-element 0d0) initial-contents)
  "A matrix of HEIGHT rows and WIDTH columns; INITIAL-CONTENTS is a list of rows."
  (let ((matrix (make-array (list height width) :element-type 'double-float :initial-element (float initial-element 1d0))))
    (loop for row in initial-contents for y from 0
          do (loop for number in row for x from 0 do (setf (aref matrix y x) (float number 1d0))))
    matrix))

(defun double-vector-sum (left right)
  (map 'double-vector #'+ left right))

(defun double-vector-difference (left right)
  (map 'double-vector #'- left right))

(defun double-vector-product (left right)
  "The scalar product of two vectors."
  (reduce #'+ (map 'vector #'* left right) :initial-value 0d0))

(defun scale-double-vector (vector factor)
  (map 'double-vector (lambda (number) (float (* number factor) 1d0)) vector))

(defun double-vector-norm (vector)
  "The length of VECTOR."
  (sqrt (double-vector-product vector vector)))

(defun height (matrix) (array-dimension matrix 0))
(defun width (matrix) (array-dimension matrix 1))

(defun map-double-matrix (function matrix)
  "A matrix of what FUNCTION makes of each element."
  (let ((result (make-double-matrix (width matrix) (height matrix))))
    (dotimes (index (array-total-size matrix) result)
      (setf (row-major-aref result index) (float (funcall function (row-major-aref matrix index)) 1d0)))))

(defun copy-double-matrix (matrix)
  (map-double-matrix #'identity matrix))

(defun combine (function left right)
  "A matrix of what FUNCTION makes of the elements of LEFT and RIGHT at each place."
  (unless (equal (array-dimensions left) (array-dimensions right))
    (error "Matrices of ~D x ~D and ~D x ~D elements do not fit." (height left) (width left) (height right) (width right)))
  (let ((result (make-double-matrix (width left) (height left))))
    (dotimes (index (array-total-size left) result)
      (setf (row-major-aref result index)
            (float (funcall function (row-major-aref left index) (row-major-aref right index)) 1d0)))))

(defun double-matrix-sum (left right) (combine #'+ left right))
(defun double-matrix-difference (left right) (combine #'- left right))

(defun scale-double-matrix (matrix factor)
  (map-double-matrix (lambda (number) (* number factor)) matrix))

(defun total (matrix)
  (loop for index below (array-total-size matrix) sum (row-major-aref matrix index)))

(defun normalize-double-matrix (matrix)
  "A matrix in the same proportions whose elements have the sum 1, a distribution; a sum that is not positive is an error."
  (let ((sum (total matrix)))
    (unless (plusp sum)
      (error "A matrix whose elements have the sum ~S is no distribution: the sum must be positive." sum))
    (scale-double-matrix matrix (/ sum))))

(defun double-matrix-transpose (matrix)
  "MATRIX with rows for columns."
  (let ((result (make-double-matrix (height matrix) (width matrix))))
    (dotimes (y (height matrix) result)
      (dotimes (x (width matrix))
        (setf (aref result x y) (aref matrix y x))))))

(defun double-matrix-product (left right)
  "The product of two matrices; the width of LEFT must be the height of RIGHT."
  (unless (= (width left) (height right))
    (error "A matrix of ~D columns cannot be multiplied with one of ~D rows." (width left) (height right)))
  (let ((result (make-double-matrix (width right) (height left))))
    (dotimes (y (height left) result)
      (dotimes (x (width right))
        (setf (aref result y x)
              (loop for k below (width left) sum (* (aref left y k) (aref right k x))))))))

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

(defun double-matrix-determinant (matrix)
  (eliminate (copy-double-matrix matrix) (make-identity-matrix (height matrix))))

(defun invert-double-matrix (matrix)
  "The inverse of MATRIX; one that has none is an error."
  (let ((inverse (make-identity-matrix (height matrix))))
    (when (zerop (eliminate (copy-double-matrix matrix) inverse))
      (error "The matrix ~S has no inverse." matrix))
    inverse))

;;; -------------------------------------------------------------------------------------------------------------- statistics

(defun mean (samples)
  "The vector of the means of SAMPLES, a list of vectors of one length."
  (make-double-vector (length (first samples))
                      :initial-contents (loop for index below (length (first samples))
                                              collect (average (mapcar (lambda (sample) (elt sample index)) samples)))))

(defun variance (numbers)
  "The mean of the squares of the distances from the mean, of a sequence of numbers."
  (let ((middle (average numbers)))
    (average (map 'list (lambda (number) (square (- number middle))) numbers))))

(defun standard-deviation (numbers)
  (sqrt (float (variance numbers) 1d0)))

(define-condition invalid-probability-distribution (error) ()
  (:report "The probabilities are 0 everywhere, so that nothing can be drawn from them.")
  (:documentation "A distribution whose sum is 0."))

(defun covariance (samples)
  "The matrix of covariances of SAMPLES, a list of vectors of one length."
  (let* ((size (length (first samples)))
         (means (loop for index below size collect (average (mapcar (lambda (sample) (elt sample index)) samples))))
         (matrix (make-double-matrix size size)))
    (dotimes (y size matrix)
      (dotimes (x size)
        (setf (aref matrix y x)
              (float (average (mapcar (lambda (sample)
                                        (* (- (elt sample y) (nth y means)) (- (elt sample x) (nth x means))))
                                      samples))
                     1d0))))))

(defun gauss (covariance mean)
  "A function of a vector: the density there of the normal distribution with this matrix of covariances and this mean."
  (let* ((inverse (invert-double-matrix covariance))
         (size (length mean))
         (factor (/ (sqrt (* (expt (* 2 pi) size) (double-matrix-determinant covariance))))))
    (lambda (point)
      (let ((offset (map 'vector #'- point mean)))
        (* factor
           (exp (* -1/2 (loop for y below size
                              sum (loop for x below size
                                        sum (* (aref offset y) (aref inverse y x) (aref offset x)))))))))))

(defun sample-gauss (mean standard-deviation)
  "A random number of the normal distribution, by the method of Box and Muller."
  (+ mean (* standard-deviation
             (sqrt (* -2 (log (- 1d0 (random 1d0)))))
             (cos (* 2 pi (random 1d0))))))

(defun 2d-cov-ellipse (covariance)
  "The ellipse of a 2 x 2 matrix of covariances: three values, half its greater axis, half its smaller one, and the angle of the former."
  (let* ((a (aref covariance 0 0)) (b (aref covariance 0 1)) (c (aref covariance 1 1))
         (middle (/ (+ a c) 2))
         (distance (sqrt (+ (square (/ (- a c) 2)) (square b)))))
    (values (sqrt (max 0d0 (+ middle distance)))
            (sqrt (max 0d0 (- middle distance)))
            (if (and (zerop b) (>= a c)) 0d0 (atan (- (+ middle distance) a) b)))))

(defun sample-from-distribution-matrix (matrix)
  "The list (column row) of an element of MATRIX that is drawn by lot; its value is its chance against the others.
No element may be negative. A matrix of zeros is an error."
  (let ((left (random 1d0)) (sum (total matrix)))
    (unless (plusp sum)
      (error "Nothing can be drawn from a matrix whose elements have the sum ~S: the sum must be positive." sum))
    (setf left (* left sum))
    (let ((drawn nil))
      (dotimes (index (array-total-size matrix))
        (let ((weight (row-major-aref matrix index)))
          (when (plusp weight)
            (setf drawn index)
            (when (< left weight) (return))
            (decf left weight))))
      (multiple-value-bind (row column) (floor drawn (width matrix))
        (list column row)))))

;;; ------------------------------------------------------------------------------------------------------------------ colours

(defun hsv->rgb (hsv)
  "The list (red green blue) of a colour (hue saturation value): the hue in degrees, all others from 0 to 1."
  (destructuring-bind (hue saturation value) (coerce hsv 'list)
    (flet ((part (offset)
             (let ((place (mod (+ offset (/ hue 60)) 6)))
               (- value (* value saturation (clamp (min place (- 4 place)) 0 1))))))
      (list (part 5) (part 3) (part 1)))))

(defun rgb->hsv (rgb)
  "The list (hue saturation value) of a colour (red green blue), as HSV->RGB takes it."
  (destructuring-bind (red green blue) (coerce rgb 'list)
    (let* ((value (max red green blue)) (range (- value (min red green blue))))
      (list (cond ((zerop range) 0)
                  ((= value red) (mod (* 60 (/ (- green blue) range)) 360))
                  ((= value green) (+ 120 (* 60 (/ (- blue red) range))))
                  (t (+ 240 (* 60 (/ (- red green) range)))))
            (if (zerop value) 0 (/ range value))
            value))))
