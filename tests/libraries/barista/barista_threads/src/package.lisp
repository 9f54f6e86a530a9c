(in-package :cl-user)

(defpackage barista-threads
  (:nicknames :bth)
  (:use #:common-lisp)
  (:import-from #:sb-thread #:with-mutex #:make-mutex #:make-thread #:join-thread)
  (:export #:count-up #:note-thing #:noted #:*counter* #:orders-with-mutex #:watch-with-timeout #:add-under-lock))
