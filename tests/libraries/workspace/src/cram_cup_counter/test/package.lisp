(defpackage #:cram-cup-counter-test
  (:use #:common-lisp #:cram-cup-counter #:lisp-unit))
