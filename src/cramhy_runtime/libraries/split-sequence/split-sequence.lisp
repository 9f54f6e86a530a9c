;;;; Sequences cut at delimiters: each function returns the list of the parts, and the index at which it stopped. Names, lambda lists
;;;; and results are those of split-sequence 2.0; the code is cramhy's own.

(defpackage #:split-sequence
  (:use #:common-lisp)
  (:export #:split-sequence #:split-sequence-if #:split-sequence-if-not))

(in-package #:split-sequence)

(defun split (sequence delimiter-p start end from-end count remove-empty-subseqs)
  "The parts of SEQUENCE between the elements for which DELIMITER-P is true, at most COUNT of them, from the end if FROM-END."
  (let* ((length (length sequence)) (end (or end length)) (parts '()) (number 0))
    (unless (<= 0 start end length)
      (error "The bounding indices ~S and ~S are bad for a sequence of length ~S." start end length))
    (labels ((left-out-p (from to)
               (and remove-empty-subseqs (= from to)))
             (full-p (from to)
               ;; empty parts that are left out are still passed over when there are enough others
               (and count (>= number count) (not (left-out-p from to))))
             (take (from to)
               (unless (left-out-p from to)
                 (push (subseq sequence from to) parts)
                 (incf number))))
      (if from-end
          (loop with right = end
                for at = (position-if delimiter-p sequence :start start :end right :from-end t)
                for left = (if at (1+ at) start)
                until (full-p left right)
                do (take left right)
                   (if at (setf right at) (return (values parts start)))
                finally (return (values parts right)))
          (loop with left = start
                for at = (position-if delimiter-p sequence :start left :end end)
                for right = (or at end)
                until (full-p left right)
                do (take left right)
                   (if at (setf left (1+ at)) (return (values (nreverse parts) end)))
                finally (return (values (nreverse parts) left)))))))

(define-condition both-tests-given (program-error) ()
  (:report "SPLIT-SEQUENCE: :TEST and :TEST-NOT cannot both be given."))

(defun split-sequence (delimiter sequence &key (start 0) (end nil) (from-end nil) (count nil) (remove-empty-subseqs nil)
                                            (test #'eql test-p) (test-not #'eql test-not-p) (key #'identity))
  "The parts of SEQUENCE between elements equal to DELIMITER, and the index at which COUNT ended it."
  (when (and test-p test-not-p)
    (error 'both-tests-given))
  (check-type test (and (or function symbol) (not null)))
  (check-type test-not (and (or function symbol) (not null)))
  (split sequence
         (if test-not-p
             (lambda (element) (not (funcall test-not delimiter (funcall key element))))
             (lambda (element) (funcall test delimiter (funcall key element))))
         start end from-end count remove-empty-subseqs))

(defun split-sequence-if (predicate sequence &key (start 0) (end nil) (from-end nil) (count nil) (remove-empty-subseqs nil)
                                               (key #'identity))
  "The parts of SEQUENCE between elements for which PREDICATE is true."
  (split sequence (lambda (element) (funcall predicate (funcall key element))) start end from-end count remove-empty-subseqs))

(defun split-sequence-if-not (predicate sequence &key (start 0) (end nil) (from-end nil) (count nil) (remove-empty-subseqs nil)
                                                   (key #'identity))
  "The parts of SEQUENCE between elements for which PREDICATE is false."
  (split sequence (lambda (element) (not (funcall predicate (funcall key element)))) start end from-end count remove-empty-subseqs))
