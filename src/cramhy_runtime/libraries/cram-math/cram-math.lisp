;;;; cram-math: angles, the normal distribution, and matrices of double-floats, as robot plans use them. Indices of matrices are
;;;; row and column; vectors are one-dimensional arrays.

(defpackage #:cram-math
  (:use #:common-lisp)
  (:nicknames #:cma)
  (:export #:degrees->radians #:radians->degrees #:normalize-angle #:average #:covariance #:gauss
           #:double-vector #:double-matrix #:make-double-vector #:make-double-matrix #:height #:width
           #:double-matrix-product #:double-matrix-transpose #:double-matrix-determinant #:invert-double-matrix #:map-double-matrix
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

(defun average (numbers)
  "The mean of a sequence of numbers."
  (/ (reduce #'+ numbers) (length numbers)))

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

(defun height (matrix) (array-dimension matrix 0))
(defun width (matrix) (array-dimension matrix 1))

(defun map-double-matrix (function matrix)
  "A matrix of what FUNCTION makes of each element."
  (let ((result (make-double-matrix (width matrix) (height matrix))))
    (dotimes (index (array-total-size matrix) result)
      (setf (row-major-aref result index) (float (funcall function (row-major-aref matrix index)) 1d0)))))

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

(defun identity-matrix (size)
  (let ((matrix (make-double-matrix size size)))
    (dotimes (index size matrix) (setf (aref matrix index index) 1d0))))

(defun double-matrix-determinant (matrix)
  (eliminate (map-double-matrix #'identity matrix) (identity-matrix (height matrix))))

(defun invert-double-matrix (matrix)
  "The inverse of MATRIX; one that has none is an error."
  (let ((inverse (identity-matrix (height matrix))))
    (when (zerop (eliminate (map-double-matrix #'identity matrix) inverse))
      (error "The matrix ~S has no inverse." matrix))
    inverse))

;;; -------------------------------------------------------------------------------------------------------------- statistics

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
