(in-package :barista-common)

(defun plural (count noun)
  (format nil "~d ~a~:[s~;~]" count noun (= count 1)))

(defun report-table (rows &key (headings '("Name" "Amount")) (stream nil))
  "ROWS, lists of a name and a number, below HEADINGS."
  (format stream "~:(~{~10a~^ ~}~)~%~{~{~10a ~6,2f~}~%~}~@[total ~6,2f~%~]"
          headings rows (when rows (reduce #'+ rows :key #'second))))

(defun roman-order (number)
  (format nil "~@r ~:@r ~:r ~b ~8,'0o ~x ~,,' ,2:d ~@d ~v@{~a~:*~}" number number number number number number (* 1000 number) number 3 number))

(defun checklist (items)
  "A sentence of ITEMS."
  (apply #'format nil "~#[nothing~;~a~;~a and ~a~:;~@{~#[~;and ~]~a~^, ~}~]" items))

(defun describe-state (state)
  "STATE, a property list, in lines; numbers in columns."
  (with-output-to-string (out)
    (loop for (key value . rest) on state by #'cddr
          for number upfrom 1
          do (format out "~2,'0d ~(~12a~)~:[~s~;~8,3,,,'0f~]~:[~;~%~]" number key (floatp value) value rest))))

(define-compiler-macro plural (&whole form count noun)
  (if (and (integerp count) (stringp noun))
      (format nil "~d ~a~:[s~;~]" count noun (= count 1))
      form))
