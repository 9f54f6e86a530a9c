(defsystem "sb-queue" :description "Queues, as SBCL had them before SB-CONCURRENCY." :depends-on ("sb-concurrency")
  :components ((:file "queue")))
