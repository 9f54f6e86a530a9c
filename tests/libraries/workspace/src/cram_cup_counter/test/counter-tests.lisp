(in-package #:cram-cup-counter-test)

(defun cups (&rest colours)
  (mapcar (lambda (colour) (make-cup :colour colour)) colours))

(define-test cups-of-one-colour-are-one-key
  (let ((counter (make-counter)))
    (mapc (lambda (cup) (count-cup counter cup)) (cups "red" "RED" "blue"))
    (assert-equal 2 (count-of counter "Red"))
    (assert-equal 1 (count-of counter "blue"))
    (assert-equal 0 (count-of counter "white"))
    (assert-equal '("blue" "red") (known-colours counter))))

(define-test several-workers-count
  (let ((counter (counted-in-parallel (make-counter) (apply #'cups (loop repeat 10 append '("red" "blue" "red"))) 3)))
    (assert-equal 20 (count-of counter "red"))
    (assert-equal 10 (count-of counter "blue"))))

(define-test the-camera-is-refused-by-name
  (assert-error 'error (grab-image 1))
  (assert-error 'cffi:foreign-not-implemented (camera-handle 1))
  (assert-true (search "camera_handle" (handler-case (camera-handle 1) (error (problem) (princ-to-string problem)))))
  (assert-equal '((:white . 0) (:red . 4) (:blue . 5)) +colours+))

(define-test what-is-watched-may-go
  (let* ((cup (make-cup :colour "red"))
         (pointer (watch cup "on the table")))
    (assert-eq cup (tg:weak-pointer-value pointer))
    (assert-equal "on the table" (gethash cup *watched*))
    (assert-eq :key (tg:hash-table-weakness *watched*))))
