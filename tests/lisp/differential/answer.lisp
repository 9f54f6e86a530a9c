;;;; What both Lisps run: (differ:answer text) reads the forms in TEXT, evaluates them in order, and tells in a string what came out:
;;;;
;;;;     | a line that the forms printed
;;;;     => the values of the last form ; as prin1 shows them
;;;;     !! the standard types of the condition that they signalled
;;;;
;;;; The texts of conditions are compared elsewhere (tests/lisp/symbols); here only what a program can see in handler-case.
(defpackage :differ (:use :cl) (:export #:answer #:serve))
(defpackage :differ-user (:use :cl))
(in-package :differ)

(defvar differ-user::*counter* 0 "For forms that are to be evaluated in an order.")

(defvar *condition-types*
  '(arithmetic-error division-by-zero floating-point-overflow floating-point-underflow cell-error unbound-variable undefined-function
    unbound-slot control-error end-of-file reader-error parse-error stream-error package-error program-error type-error
    print-not-readable file-error storage-condition error))

(defun types-of (condition)
  (remove-if-not (lambda (type) (typep condition type)) *condition-types*))

(defun values-of (text)
  (let ((form nil) (start 0) (results nil))
    (loop (setf (values form start) (read-from-string text nil text :start start))
          (when (eq form text) (return results))
          (setf results (multiple-value-list (eval form))))))

(defun shown-values (results)
  (let ((*print-pretty* nil) (*print-base* 10) (*print-radix* nil) (*print-case* :upcase) (*print-escape* t) (*print-circle* nil)
        (*print-length* 60) (*print-level* 12) (*print-array* t) (*print-gensym* t) (*print-readably* nil) (*print-lines* nil)
        (*read-base* 10) (*read-default-float-format* 'single-float) (*readtable* (copy-readtable nil)))
    (format nil "=> ~{~a~^ ; ~}" (mapcar #'prin1-to-string results))))

(defun result-of (text)
  (handler-case (handler-bind ((warning #'muffle-warning))
                  (shown-values (values-of text)))
    (serious-condition (condition) (format nil "!! ~{~a~^ ~}" (types-of condition)))))

(defun answer (text)
  (let* ((output (make-string-output-stream))
         (result (let ((*standard-output* output) (*error-output* (make-broadcast-stream)) (*trace-output* output)
                       (*standard-input* (make-string-input-stream ""))
                       (*package* (find-package :differ-user)) (*readtable* (copy-readtable nil))
                       (*print-pretty* nil) (*print-base* 10) (*print-radix* nil) (*print-case* :upcase) (*print-escape* t)
                       (*print-circle* nil) (*print-length* nil) (*print-level* nil) (*print-array* t) (*print-gensym* t)
                       (*print-readably* nil) (*print-lines* nil) (*print-miser-width* nil) (*print-right-margin* nil)
                       (*read-base* 10) (*read-default-float-format* 'single-float) (*read-eval* t) (*read-suppress* nil)
                       (*gensym-counter* 100) (differ-user::*counter* 0) (*random-state* (make-random-state nil)))
                   (result-of text))))
    (with-output-to-string (all)
      (with-input-from-string (lines (get-output-stream-string output))
        (loop for line = (read-line lines nil)
              while line do (format all "| ~a~%" line)))
      (write-string result all))))

(defun serve ()
  "Answers one text after the other, each a string that begins on a line of the input, with a string on a line."
  (let ((input *standard-input*) (output *standard-output*) (*print-pretty* nil))
    (loop for text = (read input nil)
          while text
          do (prin1 #+sbcl (handler-case (sb-ext:with-timeout 10 (answer text)) (sb-ext:timeout () "!! no end")) #-sbcl (answer text)
                    output)
             (terpri output)
             (force-output output))))
