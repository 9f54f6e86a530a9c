(defsystem barista-threads
  :depends-on (barista-plans trivial-garbage bordeaux-threads)
  :components ((:module "src" :serial t :components ((:file "package") (:file "shared")))))
