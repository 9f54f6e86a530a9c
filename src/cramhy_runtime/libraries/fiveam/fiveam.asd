(defsystem "fiveam"
  :version "1.4.2"
  :description "Tests in suites, with checks, fixtures and random data, as FiveAM of Edward Marco Baringer has them."
  :serial t
  :components ((:file "package")
               (:file "tests")
               (:file "checks")
               (:file "run")
               (:file "explain")
               (:file "random")))
