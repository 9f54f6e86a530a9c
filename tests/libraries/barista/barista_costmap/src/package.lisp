(in-package :cl-user)

(defpackage :barista-costmap
  (:nicknames #:bcm)
  (:use #:cl #:cram-prolog #:cram-utilities #:cram-designators #:cl-transforms #:cl-transforms-stamped)
  (:shadowing-import-from #:alexandria #:compose)
  (:import-from #:barista-common #:do-grid #:make-grid #:grid-cell #:grid #:make-position #:position-x #:position-y)
  (:shadow #:< #:>)
  (:export #:costmap #:make-costmap #:costmap-functions #:register-function #:costmap-values #:sample-place #:sample-places
           #:merge-costmaps #:no-functions #:function-score #:define-cost-function #:named-function
           #:near-to #:far-from-p #:in-half-plane #:gauss
           ;; facts and predicates
           #:costmap-size #:costmap-resolution #:desig-costmap #:merged-costmap #:costmap-pose #:costmap-metadata
           #:*sampling-function* #:clear-costmap-cache))
