;;;; Numbers: limits, chance, statistics, counting.

(in-package #:alexandria)

(declaim (inline clamp lerp))
(defun clamp (number min max)
  "NUMBER, or the nearer one of MIN and MAX when it is not between them."
  (cond ((< number min) min)
        ((> number max) max)
        (t number)))

(defun lerp (v a b)
  "The number that is V of the way from A to B."
  (+ (* (- 1.0 v) a) (* v b)))  ; exactly B where V is 1, which A plus a part of the difference is not

(defun gaussian-random (&optional min max)
  "Two normally distributed random double-floats, between MIN and MAX if they are given."
  (flet ((inside (number)
           (and (or (null min) (<= min number)) (or (null max) (<= number max)))))
    (when (and min max (>= min max))
      (error "GAUSSIAN-RANDOM: ~S is no smaller than ~S." min max))
    (loop
      (let* ((x (- (random 2d0) 1d0)) (y (- (random 2d0) 1d0)) (square (+ (* x x) (* y y))))
        (when (< 0d0 square 1d0)
          (let ((factor (sqrt (/ (* -2d0 (log square)) square))))
            (when (and (inside (* x factor)) (inside (* y factor)))
              (return (values (* x factor) (* y factor))))))))))

;;; ------------------------------------------------------------------------------------------------------------- statistics

(defun mean (sample)
  "The mean of the numbers in the sequence SAMPLE."
  (/ (reduce #'+ sample) (length sample)))

(defun median (sample)
  "The number in the middle of the sequence SAMPLE, or the mean of the two."
  (let* ((sorted (sort (copy-sequence 'vector sample) #'<))
         (length (length sorted))
         (middle (truncate length 2)))
    (if (oddp length)
        (aref sorted middle)
        (/ (+ (aref sorted (1- middle)) (aref sorted middle)) 2))))

(defun variance (sample &key (biased t))
  "The variance of the numbers in SAMPLE; unless BIASED, an estimate for what the sample was taken from."
  (let ((mean (mean sample)))
    (/ (reduce (lambda (sum number) (+ sum (expt (- number mean) 2))) sample :initial-value 0)
       (- (length sample) (if biased 0 1)))))

(defun standard-deviation (sample &key (biased t))
  "The square root of the variance of SAMPLE."
  (sqrt (variance sample :biased biased)))

;;; --------------------------------------------------------------------------------------------------------------- counting

(defun product (from to)
  "The product of the integers from FROM to TO, in halves, so that the factors stay small."
  (cond ((> from to) 1)
        ((< (- to from) 8) (loop with product = 1 for n from from to to do (setf product (* product n)) finally (return product)))
        (t (let ((middle (floor (+ from to) 2)))
             (* (product from middle) (product (1+ middle) to))))))

(defun factorial (n)
  "The number of orders of N things."
  (check-type n (integer 0))
  (product 1 n))

(defun binomial-coefficient (n k)
  "The number of ways to choose K of N things."
  (check-type n (integer 0))
  (check-type k (integer 0))
  (if (> k n)
      (error "Binomial coefficient: ~D of ~D things cannot be chosen." k n)
      (let ((fewer (min k (- n k))))
        (/ (product (1+ (- n fewer)) n) (product 1 fewer)))))

(defun count-permutations (n &optional (k n))
  "The number of orders of K of N things."
  (product (1+ (- n k)) n))

(defun subfactorial (n)
  "The number of orders of N things in which none is where it was."
  (check-type n (integer 0))
  (loop with before = 0 and count = 1
        for i from 1 to n
        do (psetf before count
                  count (* (1- i) (+ before count)))
        finally (return count)))
