(in-package :cram-tray-delivery-tests)
(in-suite plan-suite)

(deliverable-test a-tray-arrives ()
  (let ((log (make-delivery-log)))
    (is (eq :wood (top-level (deliver-tray log :wood))))
    (is (equal '(:wood) (deliveries log)))))

(deliverable-test a-dropped-tray-is-replaced ()
  (let ((log (make-delivery-log)))
    (is (eq :plastic (top-level (deliver-tray log :glass))))
    (signals tray-dropped (top-level (carry :glass 0.1)))
    (signals simple-plan-failure (top-level (par (carry :wood 5) (carry :glass 0.1))))))

(deliverable-test all-trays-arrive-at-once ()
  (let ((log (make-delivery-log)))
    (top-level
      (par (deliver-all log :a :b :c)
           (wait-for (cpl:= *trays-at-table* 3))))
    (is (= 3 (value *trays-at-table*)))
    (is (null (set-exclusive-or '(:a :b :c) (deliveries log))))))

(deliverable-test plans-and-threads-share-the-log ()
  (let* ((log (make-delivery-log))
         (guest (in-thread "guest" (lambda () (wait-for-deliveries log 3 :timeout 10)))))
    (top-level (deliver-all log :a :b :c))
    (is-true (sb-thread:join-thread guest))))
