;;; -*- lisp -*-

(defsystem cram-tray-delivery
  :author "Waiter"
  :license "BSD"
  :depends-on (cram-language cram-utilities alexandria #+sbcl sb-posix)
  :components
  ((:module "src"
    :components
    ((:file "package")
     (:file "delivery-log" :depends-on ("package"))
     (:file "plans" :depends-on ("package" "delivery-log")))))
  :in-order-to ((test-op (test-op cram-tray-delivery-tests))))
