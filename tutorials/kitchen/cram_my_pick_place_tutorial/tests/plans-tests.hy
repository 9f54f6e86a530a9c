(require cramhy *)
(in-package :kitchen-tests)

(defun with-bottle (&optional (place *bottle-on-counter*))
  "Begins with a bottle in the kitchen."
  (init-kitchen)
  (roslisp:set-debug-level '(pick-place) :error)
  (spawn 'bottle :bottle place))

(defun failure-of (plan)
  "The type of the failure of a plan before the counter, or nil."
  (handler-case (with-simulated-robot
                  (get-ready)
                  (go-to *before-counter*)
                  (funcall plan)
                  nil)
    (cpl:simple-plan-failure (failure)
      (type-of failure))))

(define-test a-bottle-goes-to-the-island
  (with-bottle)
  (move-bottle)
  (assert-equal '((bottle -0.8 2.0 0.96)) (things))
  (assert-equal nil (held)))

(define-test the-arm-on-its-side-comes-first
  (with-bottle)
  (flet ((first-way (y)
           (with-simulated-robot
             (get-ready)
             (go-to (pose 0.75d0 y 0))
             (look-at *bottle-on-counter*)
             (first (ways-to-take (detect :bottle))))))
    (assert-equal '(:left :left-side) (first-way 0.4d0))
    (assert-equal '(:right :right-side) (first-way 0.8d0))))

(define-test failures-have-names
  (with-bottle)
  (assert-equal 'common-fail:object-nowhere-to-be-found
                (failure-of (lambda () (find-thing :cup *bottle-on-counter*))))
  (assert-equal 'common-fail:navigation-pose-unreachable
                (failure-of (lambda () (go-to (pose 1.4d0 0.6d0 0))))))

(define-test a-bottle-at-the-side-is-found-and-fetched
  (with-bottle (pose 1.45d0 1.1d0 0.96d0))
  (assert-equal nil (failure-of (lambda () (fetch (find-thing :bottle *bottle-on-counter*)))))
  (assert-equal '(bottle) (held)))

(define-test the-robot-stands-before-the-counter-and-not-in-it
  (with-bottle)
  (assert-true (touches-nothing-p *before-counter*))
  (assert-false (touches-nothing-p (pose 1.4d0 0.6d0 0))))

(define-test a-cover-lies-before-the-guest
  (let ((origin (cl-transforms:origin (place-before 1 2 90 0.5d0 0.1d0 0))))
    (assert-number-equal 0.9 (cl-transforms:x origin))
    (assert-number-equal 2.5 (cl-transforms:y origin))))
