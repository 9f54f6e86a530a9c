(in-package :cl-user)

(defpackage barista-common
  (:nicknames :bc)
  (:documentation "Types, conditions and helpers of the barista.")
  (:use #:common-lisp)
  (:shadow #:position #:step)
  (:import-from #:alexandria
                #:when-let #:if-let #:curry #:compose #:with-gensyms #:once-only #:ensure-list #:clamp)
  (:export
   ;; utilities
   #:position #:make-position #:position-x #:position-y #:position-p #:copy-position #:step
   #:square #:distance-2d #:+robot-radius+ #:*verbosity* #:probability #:normalize
   #:while-let #:with-retries #:give-up #:try-again #:maxf #:pushnew-key #:do-alist #:angle-in-range
   #:collecting-by #:memoized #:define-memoized #:implementation-name
   ;; grids
   #:grid #:grid-width #:grid-height #:grid-resolution #:grid-origin #:make-grid #:grid-cell #:fill-grid
   #:map-grid #:grid-sum #:grid-maximum #:normalize-grid #:combine-grids #:do-grid #:grid->list
   #:out-of-grid #:out-of-grid-index #:cell #:cell-x #:cell-y #:cell-value #:best-cells
   ;; failures
   #:barista-failure #:cup-not-found #:cup-not-found-name #:pour-failed #:pour-failed-amount
   #:cannot-reach #:cannot-reach-pose #:failure-summary
   ;; reports
   #:report-table #:roman-order #:describe-state #:plural #:checklist))
