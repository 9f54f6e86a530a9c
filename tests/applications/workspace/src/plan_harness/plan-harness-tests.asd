(defsystem plan-harness-tests
  :depends-on (cram-language fiveam)
  :components ((:file "harness")))
