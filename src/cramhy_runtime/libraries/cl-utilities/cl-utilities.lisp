;;;; cl-utilities: splitting, collecting, extremes. Names and lambda lists are those of cl-utilities 1.2; the code is cramhy's own.

(defpackage #:cl-utilities
  (:use #:common-lisp)
  (:import-from #:split-sequence #:split-sequence #:split-sequence-if #:split-sequence-if-not)
  (:import-from #:alexandria #:with-unique-names #:with-gensyms #:once-only #:compose #:copy-array)
  (:export #:split-sequence #:split-sequence-if #:split-sequence-if-not #:partition #:partition-if #:partition-if-not
           #:extremum #:no-extremum #:extremum-fastkey #:extrema #:n-most-extreme #:n-most-extreme-not-enough-elements
           #:read-delimited #:read-delimited-bounds-error #:read-delimited-bounds-error-start
           #:read-delimited-bounds-error-end #:read-delimited-bounds-error-sequence #:expt-mod #:collecting #:collect #:with-collectors #:with-unique-names #:with-gensyms #:once-only
           #:rotate-byte #:copy-array #:compose))

(in-package #:cl-utilities)

(defun partition (delimiter sequence &rest options)
  "Older name of SPLIT-SEQUENCE."
  (apply #'split-sequence delimiter sequence options))

(defun partition-if (predicate sequence &rest options)
  "Older name of SPLIT-SEQUENCE-IF."
  (apply #'split-sequence-if predicate sequence options))

(defun partition-if-not (predicate sequence &rest options)
  "Older name of SPLIT-SEQUENCE-IF-NOT."
  (apply #'split-sequence-if-not predicate sequence options))

;;; --------------------------------------------------------------------------------------------------------------- extremes

(define-condition no-extremum (error) ()
  (:report "Cannot find extremum of empty sequence"))

(defun first-by (predicate key elements)
  "The element that would come first if ELEMENTS, a list that is not empty, were sorted."
  (reduce (lambda (best other) (if (funcall predicate (funcall key other) (funcall key best)) other best)) elements))

(defun extremum (sequence predicate &key (key #'identity) (start 0) end)
  "The element of SEQUENCE that would come first if it were sorted by PREDICATE; for an empty one the error NO-EXTREMUM."
  (let ((elements (coerce (subseq sequence start end) 'list)))
    (if (null elements)
        (restart-case (error 'no-extremum)
          (continue () :report "Return NIL instead" nil))
        (first-by predicate key elements))))

(defun extremum-fastkey (sequence predicate &rest options)
  "EXTREMUM."
  (apply #'extremum sequence predicate options))

(defun extrema (sequence predicate &key (key #'identity) (start 0) end)
  "All elements of SEQUENCE before which none would come if it were sorted by PREDICATE."
  (let ((elements (coerce (subseq sequence start end) 'list)))
    (when elements
      (let ((best (funcall key (first-by predicate key elements))))
        (remove-if (lambda (element) (funcall predicate best (funcall key element))) elements)))))

(define-condition n-most-extreme-not-enough-elements (warning)
  ((n :initarg :n) (subsequence :initarg :subsequence))
  (:report (lambda (condition stream)
             (with-slots (n subsequence) condition
               (format stream "There are not enough elements in the sequence ~S~% to find the ~D most extreme elements" subsequence n)))))

(defun n-most-extreme (n sequence predicate &key (key #'identity) (start 0) end)
  "The N elements of SEQUENCE that would come first if it were sorted by PREDICATE; that there are fewer is a warning."
  (check-type n (integer 0))
  (let ((elements (coerce (subseq sequence start end) 'list)))
    (when (< (length elements) n)
      (warn 'n-most-extreme-not-enough-elements :n n :subsequence elements))
    (let ((sorted (stable-sort (copy-list elements) predicate :key key)))
      (subseq sorted 0 (min n (length sorted))))))

;;; ------------------------------------------------------------------------------------------------------------- collecting

(defmacro collecting (&body body)
  "The list of what (COLLECT thing) was called with in BODY."
  (with-gensyms (list)
    `(let ((,list '()))
       (flet ((collect (thing) (push thing ,list) thing))
         (declare (ignorable #'collect))
         ,@body)
       (nreverse ,list))))

(defmacro with-collectors ((&rest collectors) &body body)
  "Each of COLLECTORS is a function in BODY; the values are the lists of what they were called with."
  (let ((lists (loop for collector in collectors collect (gensym (string collector)))))
    `(let ,(mapcar (lambda (list) `(,list '())) lists)
       (flet ,(mapcar (lambda (collector list) `(,collector (thing) (push thing ,list) thing)) collectors lists)
         ,@body)
       (values ,@(mapcar (lambda (list) `(nreverse ,list)) lists)))))

;;; ---------------------------------------------------------------------------------------------------------------- numbers

(defun expt-mod (n exponent modulus)
  "N to the power EXPONENT, modulo MODULUS."
  (unless (and (integerp n) (integerp exponent) (integerp modulus))
    (return-from expt-mod (mod (expt n exponent) modulus)))
  (loop with result = 1
        for square = n then (mod (* square square) modulus)
        for rest = exponent then (ash rest -1)
        until (zerop rest)
        do (when (oddp rest) (setf result (mod (* result square) modulus)))
        finally (return (mod result modulus))))

(defun rotate-byte (count bytespec integer)
  "INTEGER with the bits in BYTESPEC rotated to the left by COUNT."
  (let ((size (byte-size bytespec)))
    (if (zerop size)
        integer
        (let ((count (mod count size)) (field (ldb bytespec integer)))
          (dpb (logior (ldb (byte size 0) (ash field count)) (ash field (- count size))) bytespec integer)))))

(define-condition read-delimited-bounds-error (error)
  ((start :initarg :start :reader read-delimited-bounds-error-start)
   (end :initarg :end :reader read-delimited-bounds-error-end)
   (sequence :initarg :sequence :reader read-delimited-bounds-error-sequence))
  (:report (lambda (condition stream)
             (format stream "The bounding indices ~S and ~S are bad for a sequence of length ~S"
                     (read-delimited-bounds-error-start condition) (read-delimited-bounds-error-end condition)
                     (length (read-delimited-bounds-error-sequence condition))))))

(defun bounds (sequence start end)
  "START and END, the length of SEQUENCE where they are left out; an error with a remedy where they are no bounds of SEQUENCE."
  (let* ((length (length sequence)) (first (or start 0)) (last (or end length)))
    (flet ((in-place-of (remedy first last)
             (restart-case (error 'read-delimited-bounds-error :start start :end end :sequence sequence)
               (continue () :report (lambda (stream) (write-string remedy stream)) (bounds sequence first last)))))
      (cond ((not (<= 0 first length)) (in-place-of "Use default for START instead" 0 last))
            ((not (<= 0 last length)) (in-place-of "Use default for END instead" first length))
            ((< last first) (in-place-of "Switch start and end" last first))
            (t (values first last))))))

(defun read-delimited (sequence stream &key (start 0) end (delimiter #\Newline) (test #'eql) (key #'identity))
  "Read elements of STREAM into SEQUENCE up to DELIMITER. The index after the last one, and whether the delimiter was read."
  (check-type start (or integer null))
  (check-type end (or integer null))
  (multiple-value-bind (start end) (bounds sequence start end)
    (loop for index from start below end
          for element = (read-char stream nil)
          do (cond ((null element) (return (values index nil)))
                   ((funcall test (funcall key element) delimiter) (return (values index t)))
                   (t (setf (elt sequence index) element)))
          finally (return (values end nil)))))
