(in-package :cram-tray-delivery-tests)

(def-suite tray-delivery :description "All that concerns trays")
(def-suite delivery-log-suite :description "The log" :in tray-delivery)
(def-suite plan-suite :description "The plans" :in tray-delivery)
(def-suite time-suite :description "Timeouts" :in tray-delivery)

(defparameter *longest-test* 20 "Seconds after which a test hangs.")

(defmacro deliverable-test (name (&key (limit '*longest-test*)) &body body)
  "A test that is ended when it hangs."
  `(test ,name
     (handler-bind ((sb-sys:deadline-timeout
                      (lambda (condition)
                        (declare (ignore condition))
                        (error "~a hangs" ',name))))
       (sb-sys:with-deadline (:seconds ,limit)
         ,@body))))

(defun in-thread (name function)
  (sb-thread:make-thread function :name name))
