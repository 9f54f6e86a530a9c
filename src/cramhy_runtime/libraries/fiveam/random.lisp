;;;; Tests with random data, and the functions that make the data.

(in-package #:it.bese.fiveam)

(defvar *num-trials* 100 "How many times the body of FOR-ALL runs.")
(defvar *max-trials* 10000 "How many times data is made for it, since guards may refuse it.")

(defmacro for-all (bindings &body body)
  "Run BODY many times. A binding is (VARIABLE GENERATOR GUARD): BODY does not run with data for which a guard is false."
  (dolist (binding bindings)
    (unless (and (consp binding) (<= 2 (length binding) 3))
      (error "FOR-ALL: a binding is (VARIABLE GENERATOR) or (VARIABLE GENERATOR GUARD), not ~S." binding)))
  (let ((data (gensym "DATA")))
    `(perform-trials (list ,@(mapcar #'second bindings))
                     (lambda (,data)
                       (destructuring-bind ,(mapcar #'first bindings) ,data
                         (declare (ignorable ,@(remove-if-not #'symbolp (mapcar #'first bindings))))
                         (if (and ,@(remove nil (mapcar #'third bindings)))
                             (progn ,@body t)
                             nil))))))

(defun trial (generators body)
  "One trial: its data, whether BODY ran with it, and its results."
  (let ((*results* '()) (data (mapcar #'funcall generators)))
    (values data (funcall body data) *results*)))

(defun perform-trials (generators body)
  "Call BODY with data from GENERATORS until it has run often enough, or a check in it failed."
  (let ((trials 0))
    (dotimes (attempt *max-trials*)
      (when (>= trials *num-trials*) (return))
      (multiple-value-bind (data ran results) (trial generators body)
        (when ran
          (incf trials)
          (when (null results)
            (return-from perform-trials
              (add-result 'test-failure :reason "No tests" :place (cramhy::source-position))))
          (when (some (lambda (result) (typep result 'test-failure)) results)
            (return-from perform-trials
              (add-result 'for-all-test-failed :reason (format nil "Falsifiable with ~S" data) :result-list results
                                               :place (some #'place results)))))))
    (if (plusp trials)
        (process-pass nil)
        (add-result 'test-failure :reason "Guard conditions never passed" :place (cramhy::source-position)))))

;;; ------------------------------------------------------------------------------------------------------------- generators

(defun random-integer (min max)
  "A random integer from MIN to MAX."
  (+ min (random (1+ (- max min)))))

(defun gen-integer (&key (max (1+ most-positive-fixnum)) (min (1- most-negative-fixnum)))
  "A function that makes integers from MIN to MAX."
  (lambda () (random-integer min max)))

(defun gen-float (&key bound (type 'short-float))
  "A function that makes floats of TYPE between -BOUND and BOUND."
  (let ((bound (coerce (or bound (/ most-positive-single-float 2)) type)))
    (lambda () (- (random (* 2 bound)) bound))))

(defun gen-character (&key (code-limit char-code-limit) (code (gen-integer :min 0 :max (1- code-limit))) (alphanumericp nil))
  "A function that makes characters; with ALPHANUMERICP only letters and digits."
  (lambda ()
    (dotimes (attempt 10000 (error "After 10000 iterations ~S has still not generated ~:[a valid~;an alphanumeric~] character :(."
                                   code alphanumericp))
      (let ((code (funcall code)))
        (unless (<= #xD800 code #xDFFF)   ; no characters
          (let ((character (code-char code)))
            (when (and character (or (not alphanumericp) (alphanumericp character)))
              (return character))))))))

(defun gen-string (&key (length (gen-integer :min 0 :max 80)) (elements (gen-character)) (element-type 'character))
  "A function that makes strings."
  (declare (ignore element-type))
  (lambda ()
    (coerce (loop repeat (funcall length) collect (funcall elements)) 'string)))

(defun gen-list (&key (length (gen-integer :min 0 :max 10)) (elements (gen-integer :min -10 :max 10)))
  "A function that makes lists."
  (lambda () (loop repeat (funcall length) collect (funcall elements))))

(defun gen-buffer (&key (length (gen-integer :min 0 :max 50)) (element-type '(unsigned-byte 8))
                     (elements (gen-integer :min 0 :max (1- (expt 2 8)))))
  "A function that makes vectors of bytes."
  (lambda ()
    (let ((buffer (make-array (funcall length) :element-type element-type)))
      (map-into buffer elements))))

(defun gen-one-element (&rest elements)
  "A function that chooses one of ELEMENTS."
  (lambda () (nth (random (length elements)) elements)))

(defun gen-tree (&key (size 20) (elements (gen-integer :min -10 :max 10)))
  "A function that makes trees of conses with at most SIZE levels."
  (labels ((tree (level)
             (if (< (random size) level)
                 (funcall elements)
                 (cons (tree (1+ level)) (tree (1+ level))))))
    (lambda () (tree 1))))
