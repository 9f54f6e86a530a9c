(in-package :cl-user)

(defpackage barista-knowledge
  (:nicknames :bk)
  (:use #:common-lisp #:cram-prolog)
  (:import-from #:cut #:var-value #:lazy-car #:force-ll #:lazy-mapcar #:with-vars-bound #:is-var)
  (:export #:thing #:thing-name #:thing-kind #:thing-pose #:cup #:mug #:glass #:tray #:cup-volume #:cup-content #:cup-temperature
           #:add-thing #:find-thing #:forget-things #:pour #:carry-limit #:weigh #:capacity
           #:def-thing-type #:thing-types #:grasp #:grasp-offset #:calculate-grasp #:best-grasp
           #:known-thing #:kind-of #:graspable #:fits-on #:arms #:free-arm #:heavier #:serving-order #:*things*))
