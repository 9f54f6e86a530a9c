;;;; Records what SBCL's UIOP answers: sbcl --script record_uiop.lisp < uiop.txt
;;;; A form stands on one line of the input, and its answer below: the value, or ERROR and the class of the condition. FOLDER is a new folder.
(require :asdf)
(setf *error-output* (make-broadcast-stream) *print-pretty* nil)
(declaim (sb-ext:muffle-conditions warning))

(defvar *folder* (format nil "/tmp/uiop-~36r" (random (expt 36 12) (make-random-state t))))
(ensure-directories-exist (format nil "~a/" *folder*))

(defun replaced (text old new)
  (loop for start = 0 then (+ place (length old))
        for place = (search old text :start2 start)
        collect (subseq text start place) into parts
        while place collect new into parts
        finally (return (apply #'concatenate 'string parts))))

(defun one-line (text)
  (format nil "~{~a~^ ~}"
          (remove "" (uiop:split-string text :separator '(#\Space #\Newline)) :test #'string=)))

(loop for line = (read-line *standard-input* nil)
      for number from 0
      while line
      when (char= (char line 0) #\;) do (setf number -1)
      when (and (evenp number) (>= number 0))
        do (write-line line)
           (write-line
            (replaced
             (handler-case
                 (handler-bind ((warning #'muffle-warning))
                   (one-line (prin1-to-string (let ((*standard-output* (make-broadcast-stream))) (eval (read-from-string (replaced line "FOLDER" *folder*)))))))
               ((or error uiop:invalid-configuration) (condition) (format nil "ERROR ~a" (symbol-name (type-of condition)))))
             *folder* "FOLDER")))
(uiop:delete-directory-tree (uiop:ensure-directory-pathname *folder*) :validate t)
