;;;; The PR2 of Willow Garage, as facts.

(defpackage #:cram-pr2-description
  (:use #:common-lisp #:cram-prolog #:cram-robot-interfaces)
  (:export #:pr2 #:get-hand-link-names))
