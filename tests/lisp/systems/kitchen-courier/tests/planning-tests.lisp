(in-package #:kitchen-courier-tests)

(define-test matching
  (assert-equal '(((courier-plans::?x . 1)) t) (multiple-value-list (courier-plans:match '(a courier-plans::?x) '(a 1))))
  (assert-false (nth-value 1 (courier-plans:match '(courier-plans::?x courier-plans::?x) '(1 2))))
  (assert-true (nth-value 1 (courier-plans:match '((courier-plans::?is evenp courier-plans::?n) courier-plans::?*) '(4 5 6))))
  (assert-false (nth-value 1 (courier-plans:match '((courier-plans::?is evenp courier-plans::?n)) '(3))))
  (assert-equal '(go 1 (1 . b)) (courier-plans:substitute-bindings '((x . 1) (y . b)) '(go x (x . y)))))

(define-test paths
  (let ((map (courier-costmap:block-cells (courier-costmap:make-costmap 5 5) '(1 0 1 3) '(3 1 3 4))))
    (multiple-value-bind (path cost) (courier-plans:find-path map '(0 0) '(4 4))
      (assert-eql 17 (length path))
      (assert-eql 16 cost)
      (assert-eql cost (courier-plans:path-cost map path)))
    (courier-costmap:block-cells map '(1 4 1 4))
    (assert-equal '(nil nil 5) (multiple-value-list (courier-plans:find-path map '(0 0) '(4 4))))
    (assert-equal '(nil :limit 2) (multiple-value-list (courier-plans:find-path map '(0 0) '(4 4) :limit 2)))))

(define-test plans
  (in-kitchen ()
    (multiple-value-bind (plan cost) (courier-plans:plan-for '((courier-plans::bring courier-world:my-bowl courier-world:sink)))
      (assert-equal '(courier-plans::pick-up courier-plans::go-to courier-plans::put-down) (mapcar #'first plan))
      (assert-eql 4 cost))
    (assert-equal '() (courier-plans:plan-for '((courier-plans::be-at table))))
    (assert-error 'courier-plans:no-plan (courier-plans:plan-for '((courier-plans::bring sofa table))))
    (assert-error 'error (courier-plans:plan-for '((fly away))))
    (assert-eq 'sofa (handler-case (courier-plans:plan-for '((courier-plans::hold sofa)))
                       (courier-plans:no-plan (condition) (second (courier-plans:no-plan-task condition)))))))
