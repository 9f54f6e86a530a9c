;;;; cffi-ros-utils: a package that others :use. What it has in the original finds libraries of C, and cramhy calls no functions of C.

(defpackage #:cffi-ros-utils
  (:use #:common-lisp #:cffi))
