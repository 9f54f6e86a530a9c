(in-package #:kitchen-courier-tests)

(define-test macros
  "The macros expand as they should, and evaluate once."
  (assert-expands (cond ((or (string-equal x "a")) 1) (t 2)) (string-case-of-symbol x))
  (assert-equal '(3 1) (let ((calls 0)) (flet ((two () (incf calls) "two"))
                                          (list (string-case (two) ("one" 1) (("TWO" "three") 3)) calls))))
  (assert-equal '(1 2 3) (collecting (note) (mapc #'note '(1 2 3))))
  (assert-eql 2 (gethash '(a) (collect-into (note) (note '(a)) (note '(a)) (note '(b)))))
  (assert-equal '(2 nil 7) (list (aif (find 2 '(1 2)) it) (aif nil it) (acond (nil 1) ((+ 3 4)) (t 9))))
  (assert-eql 3 (let ((n 0)) (while (< n 3) (incf n)) n))
  (assert-equal "4-3" (-> 3 1+ (list 3) #'(lambda (x) (format nil "~{~A~^-~}" x))))
  (assert-equal '((:b 2) (:a 1)) (let (all) (do-plist (key value '(:a 1 :b 2) all) (push (list key value) all))))
  (assert-equal '(1 2 3 4) (let ((list (list (list 1)))) (appendf (first list) '(2) '(3 4)) (first list)))
  (assert-eql 120 (funcall (named-lambda fact (n) (if (zerop n) 1 (* n (fact (1- n))))) 5))
  (assert-equal '(2 1) (multiple-value-list (funcall (compose (lambda (a b) (values b a)) (lambda (n) (values 1 n))) 2)))
  (assert-eql 10 (funcall (curry #'+ 1 2) 3 4)))

(defmacro string-case-of-symbol (name) `(cond ((or (string-equal ,name "a")) 1) (t 2)))

(defmemo slow-square (n)
  "N times N."
  (when (minusp n) (return-from slow-square :negative))
  (* n n))

(define-test memory
  (assert-equal '(49 :computed) (multiple-value-list (slow-square 7)))
  (assert-equal '(49 :remembered) (multiple-value-list (slow-square 7)))
  (assert-eq :negative (slow-square -1))
  (assert-eql 2 (clear-memo 'slow-square))
  (assert-equal "N times N." (documentation 'slow-square 'function)))

(define-enumeration gear low (high "up") :top)

(define-test enumerations
  (assert-eql 1 (gear-index 'high))
  (assert-equal '("Low" "up" "Top") (mapcar #'gear-label '(low high :top)))
  (assert-eql 2 (gear-case 'high (low 1) ((high :top) 2)))
  (assert-error 'error (macroexpand-1 '(gear-case x (low 1))))
  (assert-error 'type-error (gear-index 'middle))
  (assert-false (typep 'middle 'gear)))

(define-test queues
  (let ((queue (make-queue :key #'length :test #'> :initial-contents '("a" "abc" "ab"))))
    (assert-equal '("abc" "ab" "a") (collecting (note) (do-queue (word queue) (note word))))
    (assert-true (queue-empty-p queue))
    (assert-equal '(:none nil) (multiple-value-list (queue-peek queue :none)))
    (assert-prints "#<QUEUE of 0>" (let ((*package* (find-package '#:courier-util))) (princ queue))))
  (assert-true (equal (sort (list 5 1 9 1 7 3) #'<)
                      (let ((queue (make-queue)))
                        (dolist (n '(5 1 9 1 7 3)) (queue-push queue n))
                        (loop until (queue-empty-p queue) collect (queue-pop queue))))))

(define-test strings
  (assert-equal '("a" "b,c") (split "a,b,c" :separator #\, :limit 2))
  (assert-equal '("a" "b") (split "a1b" :separator #'digit-char-p))
  (assert-equalp "HELLO" (join '("he" "llo") ""))
  (assert-equal "**X**" (pad 'x 5 :side :both :with #\*))
  (assert-error 'error (pad 'x 5 :side :top)))
