;;;; Records what a library answers on SBCL: sbcl --script record.lisp SYSTEM ... < SYSTEM.txt > SYSTEM.new && mv SYSTEM.new SYSTEM.txt
;;;; The lines are those of ../lisp/sbcl/record.lisp. Debian has the libraries: apt install sbcl cl-alexandria
(setf *error-output* (make-broadcast-stream))
(require :asdf)
(let ((*standard-output* (make-broadcast-stream)))
  (mapc (intern "LOAD-SYSTEM" "ASDF") (rest sb-ext:*posix-argv*)))
(defpackage :libraries-tests (:use :cl))
(in-package :libraries-tests)
(load (merge-pathnames "../lisp/sbcl/record.lisp" *load-truename*))
