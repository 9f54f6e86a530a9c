(defsystem cram-my-pick-place-tutorial-tests
  :depends-on (cram-my-pick-place-tutorial lisp-unit)
  :components
  ((:module "tests"
    :components
    ((:file "package")
     (:file "plans-tests" :depends-on ("package"))))))
