;;;; Sequences: ends, lengths, order, permutations.

(in-package #:alexandria)

(defun emptyp (sequence)
  "Whether SEQUENCE has no element."
  (etypecase sequence
    (list (null sequence))
    (sequence (zerop (length sequence)))))

(defun sequence-of-length-p (sequence length)
  "Whether SEQUENCE has LENGTH elements; of a list no more are looked at."
  (etypecase sequence
    (null (zerop length))
    (cons (and (plusp length)
               (let ((rest (nthcdr (1- length) sequence)))
                 (and rest (null (cdr rest))))))
    (sequence (= length (length sequence)))))

(defun length= (&rest sequences)
  "Whether all SEQUENCES, or numbers that stand for lengths, are of the same length."
  (when (null (rest sequences))
    (error "You must call LENGTH= with at least two arguments"))
  (let ((length (or (find-if #'integerp sequences)
                    (length (or (find-if-not #'listp sequences) (first sequences))))))
    (every (lambda (item)
             (if (integerp item) (= item length) (sequence-of-length-p item length)))
           sequences)))

(defun first-elt (sequence)
  "The first element of SEQUENCE; an empty one is a type-error."
  (cond ((consp sequence) (car sequence))
        ((and (typep sequence '(and sequence (not list))) (not (emptyp sequence))) (elt sequence 0))
        (t (error 'type-error :datum sequence :expected-type '(and sequence (not (satisfies emptyp)))))))

(defun (setf first-elt) (object sequence)
  (first-elt sequence)
  (setf (elt sequence 0) object))

(defun last-elt (sequence)
  "The last element of SEQUENCE; an empty one is a type-error."
  (cond ((and (consp sequence) (proper-list-p sequence)) (lastcar sequence))
        ((and (typep sequence '(and sequence (not list))) (not (emptyp sequence))) (elt sequence (1- (length sequence))))
        (t (error 'type-error :datum sequence :expected-type '(and proper-sequence (not (satisfies emptyp)))))))

(defun (setf last-elt) (object sequence)
  (last-elt sequence)
  (setf (elt sequence (1- (length sequence))) object))

(defun starts-with (object sequence &key (test #'eql) (key #'identity))
  "Whether the first element of SEQUENCE is equal to OBJECT; false for what is no sequence."
  (and (typep sequence 'sequence) (not (emptyp sequence))
       (funcall test object (funcall key (elt sequence 0)))))

(defun ends-with (object sequence &key (test #'eql) (key #'identity))
  "Whether the last element of SEQUENCE is equal to OBJECT; false for an empty one."
  (and (typep sequence 'sequence) (not (emptyp sequence))
       (funcall test object (funcall key (last-elt sequence)))))

(defun starts-with-subseq (prefix sequence &rest args &key (return-suffix nil return-suffix-supplied-p) &allow-other-keys)
  "Whether SEQUENCE begins with PREFIX; with RETURN-SUFFIX the second value is what follows."
  (let* ((args (if return-suffix-supplied-p (remove-from-plist args :return-suffix) args))
         (end (or (getf args :end1) (length prefix)))
         (mismatch (or (apply #'mismatch prefix sequence args) end)))
    (if (>= mismatch end)
        (values t (when return-suffix
                    (make-suffix sequence (+ (getf args :start2 0) (- end (getf args :start1 0))))))
        (values nil nil))))

(defun make-suffix (sequence start)
  "What follows START in SEQUENCE: a vector is displaced to it."
  (if (arrayp sequence)
      (make-array (- (length sequence) start) :element-type (array-element-type sequence)
                                              :displaced-to sequence :displaced-index-offset start)
      (subseq sequence start)))

(defun ends-with-subseq (suffix sequence &key (test #'eql))
  "Whether SEQUENCE ends with SUFFIX."
  (let ((start (- (length sequence) (length suffix))))
    (and (not (minusp start))
         (every test suffix (subseq sequence start)))))

(defun copy-sequence (type sequence)
  "A fresh sequence of TYPE with the elements of SEQUENCE."
  (if (typep sequence type)
      (copy-seq sequence)
      (coerce sequence type)))

(defun proper-length (sequence)
  "The length of SEQUENCE; one that is no proper sequence is a type-error."
  (if (listp sequence) (proper-list-length sequence) (length sequence)))

(defun rotate (sequence &optional (n 1))
  "SEQUENCE with its last N elements in front; a negative N moves from the front to the end. It may be changed."
  (let ((length (proper-length sequence)))
    (if (zerop length)
        sequence
        (let ((cut (mod (- n) length)))
          (cond ((zerop cut) sequence)
                ((listp sequence) (rotated-list sequence cut))
                (t (replace sequence (concatenate 'vector (subseq sequence cut) (subseq sequence 0 cut)))))))))

(defun rotated-list (list cut)
  "The list of the same conses, beginning with number CUT."
  (let* ((before (nthcdr (1- cut) list)) (start (cdr before)))
    (setf (cdr before) nil
          (cdr (last start)) list)
    start))

(defun shuffle (sequence &key (start 0) end)
  "SEQUENCE with its elements from START to END in random order. It may be changed."
  (let ((end (or end (proper-length sequence))))
    (if (listp sequence)
        (replace sequence (shuffle (coerce (subseq sequence start end) 'simple-vector)) :start1 start :end1 end)
        (loop for index from (1- end) above start
              do (rotatef (aref sequence index) (aref sequence (+ start (random (- (1+ index) start)))))
              finally (return sequence)))))

(defun random-elt (sequence &key (start 0) end)
  "One of the elements from START to END, chosen at random."
  (let ((end (or end (proper-length sequence))))
    (when (<= end start)
      (error 'simple-type-error :datum sequence :expected-type 'sequence
                                :format-control "~S has no element from ~D to ~D." :format-arguments (list sequence start end)))
    (elt sequence (+ start (random (- end start))))))

(defun extremum (sequence predicate &key key (start 0) end)
  "The element of SEQUENCE that would come first if it were sorted by PREDICATE."
  (let ((predicate (ensure-function predicate)) (key (if key (ensure-function key) #'identity)))
    (flet ((better (best other)
             (if (funcall predicate (funcall key other) (funcall key best)) other best)))
      (if (= start (or end (length sequence)))
          nil
          (reduce #'better sequence :start start :end end)))))

;;; --------------------------------------------------------------------------------------------------- choices and orders

(defun elements-between (sequence start end)
  "The elements as a vector of their own."
  (coerce (subseq sequence start end) 'simple-vector))

(defun map-combinations (function sequence &key (start 0) end length (copy t))
  "Call FUNCTION with every choice of LENGTH elements of SEQUENCE, in their order there. Returns SEQUENCE.
Each choice is a fresh sequence, whatever COPY says."
  (declare (ignore copy))
  (let* ((elements (elements-between sequence start end))
         (size (length elements))
         (wanted (or length size)))
    (labels ((choose (from left chosen)
               (if (zerop left)
                   (funcall function (like sequence (reverse chosen)))
                   (loop for index from from to (- size left)
                         do (choose (1+ index) (1- left) (cons (svref elements index) chosen))))))
      (unless (< size wanted)
        (choose 0 wanted '())))
    sequence))

(defun like (sequence list)
  "LIST as a sequence of the kind of SEQUENCE."
  (etypecase sequence
    (list list)
    (string (coerce list 'string))
    (vector (coerce list 'vector))))

(defun map-permutations (function sequence &key (start 0) end length (copy t))
  "Call FUNCTION with every order of every choice of LENGTH elements of SEQUENCE."
  (map-combinations (lambda (combination)
                      (map-orders function combination (constantly t)))
                    sequence :start start :end end :length length :copy copy))

(defun map-orders (function sequence allowed)
  "Call FUNCTION with each order of SEQUENCE in which ALLOWED lets each element, by its number, be at its new place."
  (let ((elements (elements-between sequence 0 nil)))
    (labels ((place (numbers position placed)
               (if (null numbers)
                   (funcall function (like sequence (reverse placed)))
                   (dolist (number numbers)
                     (when (funcall allowed number position)
                       (place (remove number numbers) (1+ position) (cons (svref elements number) placed)))))))
      (place (iota (length elements)) 0 '()))))

(defun map-derangements (function sequence &key (start 0) end (copy t))
  "Call FUNCTION with every order of SEQUENCE in which no element from START to END is where it was. Returns SEQUENCE."
  (declare (ignore copy))
  (let ((end (or end (length sequence))))
    (map-orders (lambda (order)
                  (let ((whole (copy-seq sequence)))
                    (funcall function (replace whole order :start1 start))))
                (subseq sequence start end)
                #'/=))
  sequence)
