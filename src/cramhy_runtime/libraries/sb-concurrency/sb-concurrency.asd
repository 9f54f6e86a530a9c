(defsystem "sb-concurrency" :description "Queues, mailboxes and gates, as the contributed module of SBCL has them."
  :components ((:file "concurrency")))
