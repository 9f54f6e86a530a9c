;;;; SB-QUEUE: the older name of the queues of SB-CONCURRENCY.

(defpackage #:sb-queue
  (:use)
  (:import-from #:sb-concurrency #:dequeue #:enqueue #:list-queue-contents #:make-queue #:queue #:queue-count #:queue-empty-p #:queue-name #:queuep)
  (:export #:dequeue #:enqueue #:list-queue-contents #:make-queue #:queue #:queue-count #:queue-empty-p #:queue-name #:queuep))
