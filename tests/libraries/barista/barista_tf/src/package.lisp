(in-package :cl-user)

(defpackage barista-tf
  (:nicknames :btf)
  (:use #:common-lisp #:cram-utilities #:cl-transforms #:cl-transforms-stamped)
  (:import-from #:cram-prolog #:def-fact-group #:<- #:lisp-fun #:lisp-type #:prolog #:bound #:once)
  (:shadowing-import-from #:cl-transforms-stamped #:transform-pose)
  (:export
   #:*fixed-frame* #:*base-frame* #:*transformer* #:init-frames #:set-base-pose #:base-pose
   #:pose->list #:list->pose #:ensure-pose #:translate-pose #:rotate-pose-around-z #:pose-towards #:look-from-to
   #:pose-distance #:poses-equal-p #:strip-stamp #:rename-frames #:with-frames #:pose-in-frame #:poses-near
   ;; facts
   #:pose #:frame #:poses-close))
