;;;; lisp-unit: tests are named forms of a package; assertions in them count, and say what they saw. Names, lambda lists and
;;;; texts are those of lisp-unit 0.9.5; the code is cramhy's own.

(defpackage #:lisp-unit
  (:use #:common-lisp)
  (:export
   #:*print-summary* #:*print-failures* #:*print-errors* #:*summarize-results*
   #:assert-eq #:assert-eql #:assert-equal #:assert-equalp #:assert-equality #:assert-prints #:assert-expands
   #:assert-nil #:assert-true #:assert-false #:assert-error
   #:define-test #:list-tests #:test-code #:test-documentation #:remove-tests #:run-tests #:run-all-tests #:use-debugger
   #:list-tags #:tagged-tests #:remove-tags #:run-tags
   #:test-names #:failed-tests #:error-tests #:missing-tests #:print-failures #:print-errors #:summarize-results
   #:test-results-db #:signal-results #:test-run-complete #:results #:write-tap #:write-tap-to-file
   #:logically-equal #:set-equal
   ;; numbers
   #:*measure* #:*epsilon* #:*significant-figures* #:default-epsilon #:relative-error #:relative-error-norm #:norm
   #:float-equal #:assert-float-equal #:sigfig-equal #:assert-sigfig-equal #:norm-equal #:assert-norm-equal
   #:number-equal #:assert-number-equal #:numerical-equal #:assert-numerical-equal #:rational-equal #:assert-rational-equal))
