(defsystem cram-my-beginner-tutorial-tests
  :depends-on (cram-my-beginner-tutorial lisp-unit
              cl-transforms roslisp turtlesim-msg)
  :components
  ((:module "tests"
    :components
    ((:file "package")
     (:file "simple-plans-tests" :depends-on ("package"))))))
