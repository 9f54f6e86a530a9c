(in-package :cl-user)

(defpackage cram-cup-demo
  (:nicknames #:cup-demo)
  (:use #:common-lisp #:cram-prolog #:desig #:exe))
