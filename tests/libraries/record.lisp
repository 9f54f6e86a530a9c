;;;; Records what a library answers on SBCL: sbcl --script record.lisp SYSTEM ... < SYSTEM.txt > SYSTEM.new && mv SYSTEM.new SYSTEM.txt
;;;; A FOLDER/ before SYSTEM says where ASDF does not look by itself. The lines are those of ../lisp/sbcl/record.lisp. Debian has the libraries: apt install sbcl cl-alexandria
(setf *error-output* (make-broadcast-stream))
(require :asdf)
(let ((*standard-output* (make-broadcast-stream)))
  (dolist (argument (rest sb-ext:*posix-argv*))
    (if (char= (char argument (1- (length argument))) #\/)
        (push (pathname argument) (symbol-value (intern "*CENTRAL-REGISTRY*" "ASDF")))
        (funcall (intern "LOAD-SYSTEM" "ASDF") argument))))
(defpackage :libraries-tests (:use :cl))
(in-package :libraries-tests)
(load (merge-pathnames "../lisp/sbcl/record.lisp" *load-truename*))
