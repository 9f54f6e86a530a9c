(in-package #:cram-cup-counter)

(defclass counting-stream (gray:fundamental-character-output-stream)
  ((target :initarg :target :reader target)
   (lines :initform 0 :accessor counted-lines)
   (column :initform 0 :accessor column)))

(defmethod gray:stream-write-char ((stream counting-stream) character)
  (cond ((char= character #\Newline)
         (incf (counted-lines stream))
         (setf (column stream) 0))
        (t (incf (column stream))))
  (write-char character (target stream)))

(defmethod gray:stream-line-column ((stream counting-stream))
  (column stream))

(defun print-report (counter stream)
  (format stream "~&cups~%")
  (dolist (colour (known-colours counter))
    (format stream "~&~a:~10t~d~%" colour (count-of counter colour)))
  (fresh-line stream)
  stream)
