;;;; The second version of Alexandria's interface: the first one and some more.

(defpackage #:alexandria-2
  (:nicknames #:alexandria.2)
  (:use #:common-lisp #:alexandria)
  (:export #:dim-in-bounds-p #:row-major-index #:rmajor-to-indices #:delete-from-plist* #:line-up-first #:line-up-last #:subseq*))

(in-package #:alexandria-2)

(do-external-symbols (symbol '#:alexandria)
  (export symbol))

(defun dim-in-bounds-p (dimensions &rest subscripts)
  "Whether SUBSCRIPTS are those of an element of an array of DIMENSIONS."
  (and (= (length dimensions) (length subscripts))
       (every (lambda (subscript dimension) (< -1 subscript dimension)) subscripts dimensions)))

(defun row-major-index (dimensions &rest subscripts)
  "The index in row-major order of the element at SUBSCRIPTS of an array of DIMENSIONS."
  (unless (apply #'dim-in-bounds-p dimensions subscripts)
    (error "Indices ~S invalid for dimensions ~S." subscripts dimensions))
  (loop with index = 0
        for subscript in subscripts for dimension in dimensions
        do (setf index (+ (* index dimension) subscript))
        finally (return index)))

(defun rmajor-to-indices (dimensions index)
  "The subscripts of the element number INDEX in row-major order."
  (when (null dimensions)
    (error "Dimensions must be non-null."))
  (let ((size (reduce #'* dimensions)))
    (unless (< -1 index size)
      (error "Row-major index ~S invalid for array of total size ~S." index size)))
  (let ((subscripts '()))
    (dolist (dimension (reverse dimensions) subscripts)
      (multiple-value-bind (rest subscript) (floor index dimension)
        (push subscript subscripts)
        (setf index rest)))))

(defun delete-from-plist* (plist &rest keys)
  "PLIST without KEYS, and an association list of what was taken out, the last pair first."
  (let ((pairs '()))
    (loop for (key value) on plist by #'cddr
          do (when (member key keys) (push (cons key value) pairs)))
    (values (apply #'delete-from-plist plist keys) pairs)))

(defun subseq* (sequence start &optional end)
  "SUBSEQ whose END may lie behind that of SEQUENCE."
  (subseq sequence start (and end (min end (length sequence)))))

(defun line-up (forms place)
  "FORMS inside each other: PLACE puts the form so far into the next one."
  (reduce (lambda (inner form) (funcall place inner (if (listp form) form (list form)))) forms))

(defmacro line-up-first (&rest forms)
  "Each form as the first argument of the next one."
  (line-up forms (lambda (inner form) (list* (first form) inner (rest form)))))

(defmacro line-up-last (&rest forms)
  "Each form as the last argument of the next one."
  (line-up forms (lambda (inner form) (append form (list inner)))))
