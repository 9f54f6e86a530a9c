(defpackage #:cram-cup-counter
  (:use #:common-lisp)
  (:local-nicknames (#:gray #:trivial-gray-streams))
  (:export #:grab-image #:camera-handle #:+colours+ #:cup #:make-cup #:cup-colour #:counter #:make-counter #:count-cup
           #:count-of #:known-colours #:watch #:*watched* #:slots-of #:counting-stream #:counted-lines #:print-report
           #:counted-in-parallel))
