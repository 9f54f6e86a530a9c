;;;; Alexandria: small functions and macros that everybody would write again. Each behaves as the library of that name
;;;; (version 1.0.1) does, with the same lambda list; the text is cramhy's own.

(defpackage #:alexandria
  (:nicknames #:alexandria-1 #:alexandria.1.0.0)
  (:use #:common-lisp)
  (:export
   #:alist-hash-table #:alist-plist #:appendf #:array-index #:array-length #:assoc-value #:binomial-coefficient
   #:circular-list #:circular-list-p #:circular-tree-p #:clamp #:coercef #:compose #:conjoin #:copy-array #:copy-file
   #:copy-hash-table #:copy-sequence #:copy-stream #:count-permutations #:cswitch #:curry #:define-constant
   #:delete-from-plist #:delete-from-plistf #:deletef #:destructuring-case #:destructuring-ccase #:destructuring-ecase
   #:disjoin #:doplist #:emptyp #:ends-with #:ends-with-subseq #:ensure-car #:ensure-cons #:ensure-function
   #:ensure-functionf #:ensure-gethash #:ensure-list #:ensure-symbol #:eswitch #:extremum #:factorial #:featurep
   #:first-elt #:flatten #:format-symbol #:gaussian-random #:hash-table-alist #:hash-table-keys #:hash-table-plist
   #:hash-table-values #:if-let #:ignore-some-conditions #:iota #:last-elt #:lastcar #:length= #:lerp
   #:make-circular-list #:make-gensym #:make-gensym-list #:make-keyword #:map-combinations #:map-derangements
   #:map-iota #:map-permutations #:map-product #:maphash-keys #:maphash-values #:mappend #:maxf #:mean #:median #:minf
   #:multiple-value-compose #:multiple-value-prog2 #:named-lambda #:nconcf #:nreversef #:nth-value-or #:nunionf
   #:of-type #:once-only #:parse-body #:parse-ordinary-lambda-list #:plist-alist #:plist-hash-table #:proper-list
   #:proper-list-length #:proper-list-p #:proper-sequence #:random-elt #:rassoc-value #:rcurry
   #:read-file-into-byte-vector #:read-file-into-string #:read-stream-content-into-byte-vector
   #:read-stream-content-into-string #:remove-from-plist #:remove-from-plistf #:removef #:required-argument #:reversef
   #:rotate #:sequence-of-length-p #:set-equal #:setp #:shuffle #:simple-parse-error #:simple-program-error
   #:simple-reader-error #:simple-style-warning #:standard-deviation #:starts-with #:starts-with-subseq
   #:string-designator #:subfactorial #:switch #:symbolicate #:type= #:unionf #:unwind-protect-case #:variance
   #:when-let #:when-let* #:whichever #:with-gensyms #:with-input-from-file #:with-output-to-file #:with-unique-names
   #:write-byte-vector-into-file #:write-string-into-file #:xor
   ;; the signs of numbers: types and predicates
   #:positive-fixnum #:positive-fixnum-p #:positive-integer #:positive-integer-p #:positive-rational
   #:positive-rational-p #:positive-real #:positive-real-p #:positive-float #:positive-float-p #:positive-short-float
   #:positive-short-float-p #:positive-single-float #:positive-single-float-p #:positive-double-float
   #:positive-double-float-p #:positive-long-float #:positive-long-float-p #:negative-fixnum #:negative-fixnum-p
   #:negative-integer #:negative-integer-p #:negative-rational #:negative-rational-p #:negative-real #:negative-real-p
   #:negative-float #:negative-float-p #:negative-short-float #:negative-short-float-p #:negative-single-float
   #:negative-single-float-p #:negative-double-float #:negative-double-float-p #:negative-long-float
   #:negative-long-float-p #:non-positive-fixnum #:non-positive-fixnum-p #:non-positive-integer
   #:non-positive-integer-p #:non-positive-rational #:non-positive-rational-p #:non-positive-real #:non-positive-real-p
   #:non-positive-float #:non-positive-float-p #:non-positive-short-float #:non-positive-short-float-p
   #:non-positive-single-float #:non-positive-single-float-p #:non-positive-double-float #:non-positive-double-float-p
   #:non-positive-long-float #:non-positive-long-float-p #:non-negative-fixnum #:non-negative-fixnum-p
   #:non-negative-integer #:non-negative-integer-p #:non-negative-rational #:non-negative-rational-p
   #:non-negative-real #:non-negative-real-p #:non-negative-float #:non-negative-float-p #:non-negative-short-float
   #:non-negative-short-float-p #:non-negative-single-float #:non-negative-single-float-p #:non-negative-double-float
   #:non-negative-double-float-p #:non-negative-long-float #:non-negative-long-float-p))
