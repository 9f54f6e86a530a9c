;;;; Records what SBCL answers: sbcl --script record.lisp < forms > answers
;;;; A form stands on one line of the input; the output repeats it, then "=> " and the values, or "!! " with the class and the text of the error.
(setf *error-output* (make-broadcast-stream) *print-pretty* nil)
(declaim (sb-ext:muffle-conditions warning))

(defun one-line (text)
  (format nil "~{~a~^ ~}"
          (loop with start = 0
                for end = (position-if (lambda (c) (member c '(#\Space #\Newline))) text :start start)
                when (< start (or end (length text))) collect (subseq text start end)
                while end do (setf start (1+ end)))))

(loop for line = (read-line *standard-input* nil)
      while line
      unless (or (zerop (length line)) (char= (char line 0) #\;) (char= (char line 0) #\=) (char= (char line 0) #\!))
        do (write-line line)
           (handler-case (format t "=> ~{~a~^ ; ~}~%"
                                 (mapcar (lambda (v) (one-line (prin1-to-string v)))
                                         (multiple-value-list (eval (read-from-string line)))))
             (error (c) (format t "!! ~a ~a~%" (symbol-name (type-of c)) (one-line (princ-to-string c))))))
