(defpackage #:kitchen-courier-tests
  (:use #:common-lisp #:lisp-unit #:courier-util)
  (:import-from #:courier-world #:make-point #:with-world #:build-kitchen #:breakfast #:object-named)
  (:export #:run-all))

(in-package #:kitchen-courier-tests)

(defmacro in-kitchen (() &body body)
  "BODY in a new kitchen, with a robot."
  `(with-world ()
     (build-kitchen 'breakfast)
     (let ((courier-plans:*robot* (courier-plans:make-robot)))
       ,@body)))

(defun run-all () (run-tests :all '#:kitchen-courier-tests))
