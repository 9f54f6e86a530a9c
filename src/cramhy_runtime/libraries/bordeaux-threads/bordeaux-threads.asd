(defsystem "bordeaux-threads"
  :version "0.9.3"
  :description "Threads, locks, condition variables, semaphores and timeouts, as Bordeaux-Threads has them, on the tasks of cramhy."
  :serial t
  :components ((:file "version-2")
               (:file "version-1")))
