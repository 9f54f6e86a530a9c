(in-package #:cram-cup-counter-test)

(define-test the-report-goes-through-a-stream-of-ours
  (let* ((counter (make-counter))
         (out (make-string-output-stream))
         (stream (make-instance 'counting-stream :target out)))
    (mapc (lambda (cup) (count-cup counter cup)) (cups "red" "white" "red"))
    (print-report counter stream)
    (assert-equal 3 (counted-lines stream))
    (assert-equal (format nil "cups~%red:      2~%white:    1~%") (get-output-stream-string out))
    (assert-true (output-stream-p stream))
    (assert-true (typep stream 'stream))))

(define-test slots-are-listed
  (assert-equal '("LOCK" "COUNTS") (mapcar #'symbol-name (slots-of 'counter)))
  (assert-prints "cups" (print-report (make-counter) *standard-output*)))
