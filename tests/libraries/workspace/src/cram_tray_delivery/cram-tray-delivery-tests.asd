;;; -*- lisp -*-

(defsystem cram-tray-delivery-tests
  :author "Waiter"
  :license "BSD"
  :depends-on (cram-tray-delivery fiveam)
  :components
  ((:module "tests"
    :components
    ((:file "package")
     (:file "suite" :depends-on ("package"))
     (:file "log-tests" :depends-on ("package" "suite"))
     (:file "plan-tests" :depends-on ("package" "suite"))
     (:file "time-tests" :depends-on ("package" "suite")))))
  :perform (test-op (operation component)
             (flet ((symbol (name package)
                      (intern (string name) (find-package package))))
               (funcall (symbol :run! :5am) (symbol :tray-delivery :cram-tray-delivery-tests)))))
