;;;; FiveAM: tests stand in suites, suites in suites; a run gives a list of results, which are explained. Names, lambda lists and
;;;; texts are those of FiveAM 1.4; the code is cramhy's own.

(defpackage #:it.bese.fiveam
  (:use #:common-lisp)
  (:nicknames #:5am #:fiveam)
  (:export
   #:! #:!! #:!!! #:*debug-on-error* #:*debug-on-failure* #:*default-test-compilation-time* #:*max-trials*
   #:*num-trials* #:*on-error* #:*on-failure* #:*print-names* #:*run-test-when-defined* #:*test-dribble*
   #:*verbose-failures* #:debug! #:def-fixture #:def-suite #:def-suite* #:def-test #:explain
   #:explain! #:fail #:finishes #:for-all #:gen-buffer #:gen-character #:gen-float #:gen-integer #:gen-list
   #:gen-one-element #:gen-string #:gen-tree #:get-fixture #:get-test #:in-suite #:in-suite* #:is #:is-every
   #:is-false #:is-true #:make-suite #:pass #:rem-fixture #:rem-test #:results-status #:run #:run! #:run-all-tests
   #:signals #:skip #:test #:test-names #:with-fixture))
