;;;; Records what SBCL answers to a chapter of questions about the symbols of Common Lisp:
;;;;
;;;;     sbcl --script record.lisp < conses.txt > conses.new && mv conses.new conses.txt
;;;;
;;;; ";; name" begins the section of a symbol; it is evaluated in a package of its own, in order. A form begins in the first column,
;;;; and its further lines do not. Behind it stand what it printed ("| line"), and its values ("=> 1 ; 2") or the class and
;;;; the text of the error ("!! TYPE-ERROR ..."). Recording again replaces the answers; ";;;" comments stay.
;;;; Each section begins in an empty folder of its own, which is *default-pathname-defaults*; answers call it /here/.

(defvar *forms* *standard-input*)
(defvar *answers* *standard-output*)
(setf *error-output* (make-broadcast-stream))
(setf sb-impl::*default-external-format* :utf-8)
(declaim (sb-ext:muffle-conditions warning sb-ext:compiler-note))

(defun words (text)
  (format nil "~{~a~^ ~}"
          (loop with start = 0
                for end = (position-if (lambda (c) (member c '(#\Space #\Newline #\Tab))) text :start start)
                for word = (subseq text start end)
                unless (string= word "") collect word
                while end do (setf start (1+ end)))))

(defvar *folder* nil)

(defun leave-folder ()
  (when *folder* (sb-ext:delete-directory *folder* :recursive t)))

(defun begin-folder ()
  (leave-folder)
  (setf *folder* (ensure-directories-exist (format nil "/tmp/~a-~d/" (gensym "SECTION") (sb-unix:unix-getpid)))
        *default-pathname-defaults* (pathname *folder*)))

(defun here (line)
  (loop for start = (and *folder* (search *folder* line))
        while start do (setf line (concatenate 'string (subseq line 0 start) "/here/" (subseq line (+ start (length *folder*)))))
        finally (return line)))

(defun write-output (text)
  (with-input-from-string (lines text)
    (loop for line = (read-line lines nil)
          while line do (write-line (string-right-trim " " (format nil "| ~a" (here line))) *answers*))))

(defun error-line (condition)
  (let ((*print-pretty* nil))
    (words (format nil "!! ~a ~a" (symbol-name (type-of condition))
                   (handler-case (princ-to-string condition)
                     (error () "(its report fails)"))))))

(defun answer-line (text)
  (let ((sb-ext:*invoke-debugger-hook* nil)
        (*debugger-hook* (lambda (condition hook)
                           (declare (ignore hook))
                           (return-from answer-line (error-line condition)))))
    (handler-case
        (let ((values (multiple-value-list (eval (read-from-string text)))) (*print-pretty* nil))
          (words (format nil "=> ~{~a~^ ; ~}" (mapcar #'prin1-to-string values))))
      (error (condition) (error-line condition)))))

(defun answer (text)
  (let ((output (make-string-output-stream)) (answer nil))
    (let ((*standard-output* output) (*trace-output* output) (*standard-input* (make-string-input-stream "")))
      (setf answer (answer-line text)))
    (write-output (get-output-stream-string output))
    (write-line (here answer) *answers*)))

(defun starts-with (prefix line)
  (and (>= (length line) (length prefix)) (string= prefix line :end2 (length prefix))))

(let ((form nil))
  (flet ((finish ()
           (when form
             (answer form)
             (setf form nil))))
    (loop for line = (read-line *forms* nil)
          while line
          unless (or (starts-with "=>" line) (starts-with "!!" line) (starts-with "|" line))
            do (cond ((starts-with ";; " line)
                      (finish)
                      (begin-folder)
                      (setf *package* (make-package (gensym "SECTION-") :use '(:cl)))
                      (write-line line *answers*))
                     ((or (string= line "") (starts-with ";" line))
                      (finish)
                      (write-line line *answers*))
                     ((char= (char line 0) #\Space)
                      (setf form (format nil "~a~%~a" form line))
                      (write-line line *answers*))
                     (t (finish)
                        (setf form line)
                        (write-line line *answers*))))
    (finish)
    (leave-folder)))
