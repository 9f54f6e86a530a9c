;;;; pr2-em: opening and closing drawers by their handles. Nothing is exported: the plans are called by performing actions.

(defpackage #:cram-pr2-environment-manipulation
  (:nicknames #:pr2-em #:pr2-env-man)
  (:use #:common-lisp #:cram-prolog #:desig #:exe))

(in-package #:cram-pr2-environment-manipulation)
