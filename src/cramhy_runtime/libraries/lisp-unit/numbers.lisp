;;;; Assertions about numbers that need not be exactly equal.

(in-package #:lisp-unit)

(defvar *measure* 1 "How the size of a sequence of numbers is measured: 1, 2 or :INFINITY.")
(defvar *epsilon* nil "The relative error that is allowed, NIL for twice that of the floats compared.")
(defvar *significant-figures* 4 "How many figures SIGFIG-EQUAL compares.")

(defun float-epsilon (value)
  "The relative error of rounding in the floats of VALUE, a number or a sequence; zero when all is exact."
  (etypecase value
    (rational 0)
    ((or double-float (complex double-float)) (* 2d0 double-float-epsilon))
    ((or float (complex float)) (* 2.0 single-float-epsilon))
    (complex 0)
    (array (loop for index below (array-total-size value) maximize (float-epsilon (row-major-aref value index))))
    (sequence (reduce #'max (map 'list #'float-epsilon value) :initial-value 0))))

(defun default-epsilon (value1 value2)
  "The relative error that is allowed between VALUE1 and VALUE2: that of the less exact one."
  (let ((epsilon1 (float-epsilon value1)) (epsilon2 (float-epsilon value2)))
    (max epsilon1 epsilon2)))

(defun relative-error (exact approximate)
  "How far APPROXIMATE is from EXACT, in parts of EXACT."
  (abs (/ (- exact approximate) exact)))

(defun close-p (value1 value2 distance size1 size2 epsilon)
  "Whether DISTANCE is within EPSILON of the mean size; when both are that small they are equal too."
  (let ((epsilon (or epsilon *epsilon* (default-epsilon value1 value2))))
    (or (zerop distance)
        (and (< size1 epsilon) (< size2 epsilon))
        (< (/ (* 2 distance) (+ size1 size2)) epsilon))))

(defun float-equal (data1 data2 &optional (epsilon *epsilon*))
  "Whether the numbers are equal within the relative error EPSILON."
  (close-p data1 data2 (abs (- data1 data2)) (abs data1) (abs data2) epsilon))

(defun norm (data &optional (measure *measure*))
  "The size of a sequence or array of numbers: the sum of their sizes (1), its length in space (2), or the greatest (:INFINITY)."
  (let ((sizes (mapcar #'abs (elements data))))
    (ecase measure
      (1 (reduce #'+ sizes))
      (2 (sqrt (reduce #'+ (mapcar (lambda (size) (* size size)) sizes))))
      (:infinity (reduce #'max sizes)))))

(defun elements (data)
  "The numbers of a sequence or array, as a list."
  (if (typep data '(and array (not vector)))
      (loop for index below (array-total-size data) collect (row-major-aref data index))
      (coerce data 'list)))

(defun relative-error-norm (exact approximate &optional (measure *measure*))
  "The size of the difference in parts of the size of EXACT."
  (/ (norm (mapcar #'- (elements exact) (elements approximate)) measure) (norm exact measure)))

(defun norm-equal (data1 data2 &optional (epsilon *epsilon*) (measure *measure*))
  "Whether two sequences or arrays of numbers are equal within the relative error EPSILON of their sizes."
  (let ((list1 (elements data1)) (list2 (elements data2)))
    (and (= (length list1) (length list2))
         (or (null list1)
             (close-p data1 data2 (norm (mapcar #'- list1 list2) measure) (norm list1 measure) (norm list2 measure) epsilon)))))

(defun figures (number count)
  "NUMBER as an integer of COUNT significant figures and the power of ten that it is to be multiplied with."
  (if (zerop number)
      (values 0 0)
      (let* ((number (rational number))
             (power (loop with power = (- (floor (log (abs (float number 1d0)) 10)) (1- count))
                          while (>= (abs (round number (expt 10 power))) (expt 10 count)) do (incf power)
                          while (< (abs (round number (expt 10 power))) (expt 10 (1- count))) do (decf power)
                          finally (return power))))
        (values (round number (expt 10 power)) power))))

(defun sigfig-equal (data1 data2 &optional (figures *significant-figures*))
  "Whether the numbers are the same when rounded to so many significant FIGURES."
  (equal (multiple-value-list (figures data1 figures)) (multiple-value-list (figures data2 figures))))

(defun number-equal (number1 number2 &optional (epsilon *epsilon*) type-eq-p)
  "Whether the numbers are equal, within EPSILON if one is a float; with TYPE-EQ-P only if they are of one type."
  (and (or (not type-eq-p) (equal (type-of number1) (type-of number2)))
       (if (or (floatp (realpart number1)) (floatp (realpart number2)))
           (float-equal number1 number2 epsilon)
           (= number1 number2))))

(defun numerical-equal (result1 result2 &key (test #'number-equal))
  "Whether two numbers, or sequences or arrays of them to any depth, are equal under TEST."
  (cond ((and (numberp result1) (numberp result2)) (funcall test result1 result2))
        ((and (typep result1 'sequence) (typep result2 'sequence))
         (and (= (length result1) (length result2))
              (every (lambda (a b) (numerical-equal a b :test test)) result1 result2)))
        ((and (arrayp result1) (arrayp result2))
         (and (equal (array-dimensions result1) (array-dimensions result2))
              (every (lambda (a b) (numerical-equal a b :test test)) (elements result1) (elements result2))))
        (t nil)))

(defun rational-equal (data1 data2)
  "Whether two exact numbers, or sequences of them, are equal."
  (cond ((and (numberp data1) (numberp data2)) (= data1 data2))
        ((and (typep data1 'sequence) (typep data2 'sequence))
         (and (= (length data1) (length data2)) (every #'rational-equal data1 data2)))
        (t nil)))

(defmacro assert-float-equal (expected form &rest extras)
  "FORM's value is FLOAT-EQUAL to EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'float-equal))

(defmacro assert-sigfig-equal (figures expected form &rest extras)
  "FORM's value is equal to EXPECTED in so many significant FIGURES."
  `(expand-assert :equal ,form ,form ,expected ,extras
                  :test (lambda (data1 data2) (sigfig-equal data1 data2 ,figures))))

(defmacro assert-norm-equal (expected form &rest extras)
  "FORM's value is NORM-EQUAL to EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'norm-equal))

(defmacro assert-number-equal (expected form &rest extras)
  "FORM's value is NUMBER-EQUAL to EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'number-equal))

(defmacro assert-numerical-equal (expected form &rest extras)
  "FORM's value is NUMERICAL-EQUAL to EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'numerical-equal))

(defmacro assert-rational-equal (expected form &rest extras)
  "FORM's value is RATIONAL-EQUAL to EXPECTED."
  `(expand-assert :equal ,form ,form ,expected ,extras :test #'rational-equal))
