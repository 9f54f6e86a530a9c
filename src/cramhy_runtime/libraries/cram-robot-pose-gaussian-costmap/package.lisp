;;;; cram-robot-pose-gaussian-costmap: costmaps for (a location (reachable-for ...)), (visible-for ...) and (reachable-from ...).
;;;; The package is called guassian in the original, too.

(defpackage #:cram-robot-pose-guassian-costmap
  (:nicknames #:gaussian-costmap)
  (:use #:common-lisp #:cram-designators #:cram-location-costmap #:cram-prolog))
