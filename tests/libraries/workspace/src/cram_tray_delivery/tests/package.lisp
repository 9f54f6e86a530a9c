(in-package :cl-user)

(defpackage :cram-tray-delivery-tests
  (:use #:common-lisp #:cram-tray-delivery #:fiveam)
  (:import-from #:cram-language
                #:top-level #:par #:pursue #:wait-for #:make-fluent #:fl-and #:value #:simple-plan-failure #:whenever)
  (:shadowing-import-from #:fiveam #:fail))
