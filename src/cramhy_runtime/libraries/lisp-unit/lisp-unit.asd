(defsystem "lisp-unit"
  :version "0.9.5"
  :description "Unit tests: define-test, assertions, summaries, as lisp-unit of Chris Riesbeck and Thomas Hermann has them."
  :serial t
  :components ((:file "package")
               (:file "tests")
               (:file "assertions")
               (:file "reports")
               (:file "running")
               (:file "numbers")))
