;;; Records what SBCL answers to the forms of a file, one JSON array [form, answer] per line:
;;;     FORMS=forms.lisp sbcl --script record.lisp > answers.jsonl
;;; The answer is the string that the form returns, or its printed value, or "ERROR " and the report of the error.
(defun json (text)
  (with-output-to-string (out)
    (write-char #\" out)
    (loop for char across text
          do (case char
               (#\" (write-string "\\\"" out))
               (#\\ (write-string "\\\\" out))
               (#\Newline (write-string "\\n" out))
               (t (if (<= 32 (char-code char) 126)
                      (write-char char out)
                      (format out "\\u~4,'0x" (char-code char))))))
    (write-char #\" out)))

(defun answer (form)
  (handler-case (let ((value (eval form)))
                  (if (stringp value) value (prin1-to-string value)))
    (error (condition) (format nil "ERROR ~a" condition))))

(with-open-file (in (sb-ext:posix-getenv "FORMS"))
  (loop for start = (file-position in)
        for form = (read in nil in)
        for end = (file-position in)
        until (eq form in)
        do (let ((text (make-string (- end start))))
             (file-position in start)
             (read-sequence text in)
             (file-position in end)
             (format t "[~a, ~a]~%" (json (string-trim '(#\Newline #\Space) text)) (json (answer form))))))
