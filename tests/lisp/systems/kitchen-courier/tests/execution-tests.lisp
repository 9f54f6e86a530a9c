(in-package #:kitchen-courier-tests)

(define-test execution
  (in-kitchen ()
    (multiple-value-bind (result log)
        (courier-plans:with-event-log ()
          (courier-plans:execute '((courier-plans::bring courier-world:red-cup courier-world:sink))))
      (assert-eq :succeeded result)
      (assert-eql 3 (courier-plans:count-events :start log))
      (assert-eql 0 (courier-plans:count-events :failure log)))
    (assert-eq 'courier-world:sink (courier-world:location-of 'courier-world:red-cup))))

(define-test recovery
  (assert-equal '(:done 3) (let ((tries 0))
                             (multiple-value-list
                              (courier-plans:with-recovery ((courier-plans:grasp-failed (failure) (retry-if-possible #'courier-plans:retry failure)))
                                (when (< (incf tries) 3) (error 'courier-plans:grasp-failed))
                                (values :done tries)))))
  (assert-error 'courier-plans:navigation-failed
                (courier-plans:with-recovery ((courier-plans:grasp-failed (failure) (courier-plans:retry))
                                              (courier-plans:navigation-failed (failure :retries 1) (courier-plans:retry)))
                  (error 'courier-plans:navigation-failed :place 'sink)))
  (assert-eq 'cup (courier-plans:with-recovery ((error (failure) (courier-plans:give-up (courier-plans:failure-object failure))))
                    (error 'courier-plans:grasp-failed :object 'cup)))
  (assert-equal '(courier-plans::object-slipped-and-broke courier-plans:object-slipped courier-plans:grasp-failed)
                (loop for type in '(courier-plans::object-slipped-and-broke courier-plans:object-slipped courier-plans:grasp-failed
                                    courier-plans:navigation-failed)
                      when (subtypep type 'courier-plans:grasp-failed) collect type)))

(defun retry-if-possible (retry failure)
  (incf (courier-plans:attempts failure))
  (funcall retry))

(define-test faults
  (in-kitchen ()
    (courier-plans:with-faults ((:navigation 1 2 3 4 5 6 7 8 9))
      (assert-equal '(:failed 0 "sink was not reached (somebody stood there)." 3)
                    (multiple-value-list (courier-plans:execute '((courier-plans::be-at courier-world:sink))))))
    (assert-eql 1 (let ((warnings 0))
                    (handler-bind ((warning (lambda (warning) (incf warnings) (muffle-warning warning))))
                      (setf (courier-plans:battery courier-plans:*robot*) 20)
                      (courier-plans:perform 'courier-plans::go-to 'courier-world:sink)
                      warnings)))
    (assert-error 'courier-plans:robot-exhausted
                  (progn (setf (courier-plans:battery courier-plans:*robot*) 4)
                         (courier-plans:perform 'courier-plans::go-to 'courier-world:fridge)))))
