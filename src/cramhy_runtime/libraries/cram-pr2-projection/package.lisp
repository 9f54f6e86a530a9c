;;;; pr2-proj: motions happen in the current world, at once.

(defpackage #:cram-pr2-projection
  (:nicknames #:pr2-proj #:urdf-proj)
  (:use #:common-lisp #:cram-prolog)
  (:export #:with-simulated-robot #:with-projected-robot #:pr2-bullet-projection-environment #:projection-role
           #:pr2-proj-navigation #:pr2-proj-torso #:pr2-proj-ptu #:pr2-proj-perception #:pr2-proj-grippers #:pr2-proj-arms
           #:*torso-step* #:*last-timeline* #:*debug-short-sleep-duration* #:*debug-long-sleep-duration*
           #:action-duration #:projection-timestamp-function #:execute-as-action))

(in-package #:cram-pr2-projection)

;;; The robot is the PR2, unless another one was described before.
(unless (cram-robot-interfaces:current-robot-symbol)
  (asdf:load-system :cram-pr2-description))
