;;;; Assertions about numbers that need not be exactly equal.

(in-package #:lisp-unit)

(defvar *measure* 1 "How the size of a sequence of numbers is measured: 1, 2 or :INFINITY.")
(defvar *epsilon* nil "The relative error that is allowed, NIL for twice that of the floats compared.")
(defvar *significant-figures* 4 "How many figures SIGFIG-EQUAL compares.")

(defgeneric default-epsilon (value)
  (:documentation "The relative error of rounding in VALUE, a float, or in the floats of a sequence or an array.")
  (:method ((value double-float)) (* 2d0 double-float-epsilon))
  (:method ((value float)) (* 2.0 single-float-epsilon))
  (:method ((value complex)) (rounding (realpart value)))
  (:method ((value list)) (reduce #'max (mapcar #'rounding value) :initial-value 0))
  (:method ((value array)) (default-epsilon (elements value))))

(defun rounding (value)
  "As DEFAULT-EPSILON, and zero for what is exact."
  (if (rationalp value) 0 (default-epsilon value)))

(defgeneric relative-error (exact approximate)
  (:documentation "How far APPROXIMATE is from EXACT, in parts of EXACT.")
  (:method ((exact number) (approximate number))
    (check-type exact (or float complex))
    (check-type approximate (or float complex))
    (abs (/ (- exact approximate) exact))))

(defun close-p (value1 value2 distance size1 size2 epsilon)
  "Whether DISTANCE is within EPSILON of the mean size; when both are that small they are equal too."
  (let ((epsilon (or epsilon *epsilon* (max (rounding value1) (rounding value2)))))
    (or (zerop distance)
        (and (< size1 epsilon) (< size2 epsilon))
        (< (/ (* 2 distance) (+ size1 size2)) epsilon))))

(defun every-pair-p (test data1 data2)
  "Whether two sequences of one length, or two arrays of the same dimensions, hold numbers that are equal under TEST, pair by pair."
  (if (or (typep data1 'sequence) (typep data2 'sequence))
      (and (= (length data1) (length data2)) (every test data1 data2))
      (and (equal (array-dimensions data1) (array-dimensions data2)) (every test (elements data1) (elements data2)))))

(defgeneric float-equal (data1 data2 &optional epsilon)
  (:documentation "Whether the numbers, or those of two sequences or arrays, are equal within the relative error EPSILON.")
  (:method ((data1 number) (data2 number) &optional (epsilon *epsilon*))
    (if (and (rationalp (realpart data1)) (rationalp (realpart data2)))
        (error "FLOAT-EQUAL compares floats, and neither ~S nor ~S is one. Use = or NUMBER-EQUAL." data1 data2)
        (close-p data1 data2 (abs (- data1 data2)) (abs data1) (abs data2) epsilon)))
  (:method ((data1 sequence) (data2 sequence) &optional (epsilon *epsilon*))
    (every-pair-p (lambda (a b) (float-equal a b epsilon)) data1 data2))
  (:method ((data1 array) (data2 array) &optional (epsilon *epsilon*))
    (every-pair-p (lambda (a b) (float-equal a b epsilon)) data1 data2)))

(defgeneric norm (data &optional measure)
  (:documentation "The size of a sequence or array of numbers: for MEASURE 1 the sum of their sizes, for 2 the length in space, for a greater
number the root of the sum of their powers, for :INFINITY the greatest.")
  (:method ((data sequence) &optional (measure *measure*))
    (let ((sizes (map 'list #'abs data)))
      (case measure
        (1 (reduce #'+ sizes))
        (2 (sqrt (reduce #'+ (mapcar (lambda (size) (* size size)) sizes))))
        (:infinity (reduce #'max sizes))
        (t (check-type measure (integer 1))
         (expt (reduce #'+ (mapcar (lambda (size) (expt size measure)) sizes)) (/ measure))))))
  (:method ((data array) &optional (measure *measure*)) (norm (elements data) measure)))

(defun elements (data)
  "The numbers of a sequence or array, as a list."
  (if (typep data '(and array (not vector)))
      (loop for index below (array-total-size data) collect (row-major-aref data index))
      (coerce data 'list)))

(defgeneric relative-error-norm (exact approximate &optional measure)
  (:documentation "The size of the difference in parts of the size of EXACT.")
  (:method (exact approximate &optional (measure *measure*))
    (/ (norm (mapcar #'- (elements exact) (elements approximate)) measure) (norm exact measure))))

(defgeneric norm-equal (data1 data2 &optional epsilon measure)
  (:documentation "Whether two sequences or arrays of numbers are equal within the relative error EPSILON of their sizes.")
  (:method (data1 data2 &optional (epsilon *epsilon*) (measure *measure*))
    (let ((list1 (elements data1)) (list2 (elements data2)))
      (and (= (length list1) (length list2))
           (or (null list1)
               (close-p data1 data2 (norm (mapcar #'- list1 list2) measure) (norm list1 measure) (norm list2 measure) epsilon))))))

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

(defgeneric sigfig-equal (data1 data2 &optional significant-figures)
  (:documentation "Whether the numbers, or those of two sequences or arrays, are the same when rounded to so many significant figures.")
  (:method ((data1 number) (data2 number) &optional (figures *significant-figures*))
    (equal (multiple-value-list (figures data1 figures)) (multiple-value-list (figures data2 figures))))
  (:method ((data1 sequence) (data2 sequence) &optional (figures *significant-figures*))
    (every-pair-p (lambda (a b) (sigfig-equal a b figures)) data1 data2))
  (:method ((data1 array) (data2 array) &optional (figures *significant-figures*))
    (every-pair-p (lambda (a b) (sigfig-equal a b figures)) data1 data2)))

(defun number-equal (number1 number2 &optional (epsilon *epsilon*) type-eq-p)
  "Whether the numbers are equal, within EPSILON if one is a float; with TYPE-EQ-P only if they are of one type."
  (and (or (not type-eq-p) (equal (type-of number1) (type-of number2)))
       (if (or (floatp (realpart number1)) (floatp (realpart number2)))
           (float-equal number1 number2 epsilon)
           (= number1 number2))))

(defgeneric numerical-equal (result1 result2 &key test)
  (:documentation "Whether two numbers, or sequences or arrays of them to any depth, are equal under TEST.")
  (:method ((result1 number) (result2 number) &key (test #'number-equal)) (funcall test result1 result2))
  (:method ((result1 sequence) (result2 sequence) &key (test #'number-equal))
    (every-pair-p (lambda (a b) (numerical-equal a b :test test)) result1 result2))
  (:method ((result1 array) (result2 array) &key (test #'number-equal))
    (every-pair-p (lambda (a b) (numerical-equal a b :test test)) result1 result2)))

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
