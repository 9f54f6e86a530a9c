;;;; Objects of a kitchen: their kinds, how to grasp them, how firmly.

(defpackage #:cram-knowrob-pick-place
  (:use #:common-lisp #:cram-object-interfaces #:cram-prolog)
  (:nicknames #:kr-pp))
