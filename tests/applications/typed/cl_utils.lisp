(asdf:load-system :cl-utils)
;=> T

(in-package :cl-utils)
;=> .*

(build-symbol-name "FOO-" 'bar)
;=> "FOO-BAR"

(intern-compound-symbol 'a '- 'b)
;=> A-B

(let ((x 1)) (condlet (((= x 1) (y 2) (z 3)) ((= x 2) (y 4) (z 5))) (list x y z)))
;=> \(1 2 3\)

(dbind (a (b c) d) '(1 (2 3) 4) (list a b c d))
;=> \(1 2 3 4\)

(let ((i 0)) (while (< i 5) (incf i)) i)
;=> 5

(let ((i 0)) (till (>= i 3) (incf i)) i)
;=> 3

(let ((i 0)) (repeat-until (>= i 4) (incf i)) i)
;=> 4

(let ((i 0)) (repeat 7 (incf i)) i)
;=> 7

(let ((l nil)) (for-loop (i 0 3) (push i l)) l)
;=> \(2 1 0\)

(mvbind (a b) (floor 7 2) (list a b))
;=> \(3 1\)

(dsbind (a &rest b) '(1 2 3) (list a b))
;=> \(1 \(2 3\)\)

(aif (+ 1 1) (* it 10) :none)
;=> 20

(aif nil it :none)
;=> :NONE

(awhen (member 2 '(1 2 3)) (cdr it))
;=> \(3\)

(aand 1 (+ it 1) (* it 5))
;=> 10

(let ((x 4)) (_f * x 5) x)
;=> 20

(let ((x nil)) (toggle x) x)
;=> T

(let ((x nil)) (orf x 3) (orf x 4) x)
;=> 3

(let ((l '(1 2 3)) (r nil)) (awhile (pop l) (push it r)) r)
;=> \(3 2 1\)

(if-rand 1 :always :never)
;=> :ALWAYS

(if-rand 0 :always :never)
;=> :NEVER

(when-rand 0 :never)
;=> NIL

(sort (mapcar #'car (hash-table-to-alist (alist-to-hash-table '((:a . 1) (:b . 2))))) #'string<)
;=> \(:A :B\)

(let ((h (alist-to-hash-table '((:a . 1))))) (list (hash-table-has-key h :a) (hash-table-has-key h :b)))
;=> \(T NIL\)

(let ((s 0)) (do-hash-entries ((k v) (alist-to-hash-table '((:a . 1) (:b . 2))) s) (incf s v)))
;=> 3

(hash-keys (alist-to-hash-table '((:a . 1))))
;=> \(:A\)

(funcall (compose #'1+ #'abs) -5)
;=> 6

(mapcar (nth-arg-fn 1) '(1 2) '(3 4))
;=> \(3 4\)

(funcall (fn (+ car cdr)) '(1 . 2))
;=> 3

(funcall (partial #'- 10) 3)
;=> 7

(funcall (rcurry #'- 10) 3)
;=> -7

(progn (defaggregator sum-of + 0) (list (sum-of) (sum-of 1 2 3)))
;=> \(0 6\)

(blocks '(1 1 2 3 3 3))
;=> \(\(1 \. 2\) \(2 \. 1\) \(3 \. 3\)\)

(multiple-value-list (is-prefix '(1 2) '(1 2 3)))
;=> \(T\)

(multiple-value-list (is-prefix '(1 3) '(1 2 3)))
;=> \(NIL\)

(slast '(1 2 3))
;=> 3

(slast "abc")
;=> #\\c

(groups-of-size '(1 2 3 4) 2)
;=> \(\(1 2\) \(3 4\)\)

(groups-of-size '(1 2 3 4 5) 2 :allow-incomplete t)
;=> \(\(1 2\) \(3 4\)\)

(tokenize "a b  c" (list #\Space))
;=> \("a" "b" "c"\)

(filter #'evenp '(1 2 3 4))
;=> \(2 4\)

(is-permutation '(1 2 3) '(3 1 2))
;=> T

(is-permutation '(1 2 3) '(3 1 1))
;=> NIL

(length-equals 3 '(1 2 3))
;=> T

(lookup-alist :b '((:a . 1) (:b . 2)))
;=> 2

(let ((v (make-adjustable-vector))) (vector-push-extend 1 v) (vector-push-extend 2 v) v)
;=> #\(1 2\)

(let ((l nil)) (do-vec (x #(1 2 3) l) (push x l)))
;=> \(3 2 1\)

(realize (range :below 4))
;=> \(0 1 2 3\)

(realize (range :from 2 :by 3 :below 12))
;=> \(2 5 8 11\)

(realize (range :from 1 :above 3))
;=> NIL

(realize (take 3 (range)))
;=> \(0 1 2\)

(realize (take 2 (iter '(a b c))))
;=> \(A B\)

(realize (take-until #'evenp (iter '(1 3 4 5))))
;=> \(1 3\)

(realize (concat (iter '(1 2)) (iter '(3))))
;=> \(1 2 3\)

(realize (elements-satisfying #'oddp (iter '(1 2 3))))
;=> \(1 3\)

(let ((s 0)) (do-iterator (x (iter '(1 2 3)) s) (incf s x)))
;=> 6

(realize (map-iterator #'+ (iter '(1 2)) (iter '(10 20))))
;=> \(1 2\)

(close-to 1.0 1.0000001)
;=> T

(close-to 1.0 1.1)
;=> NIL

(mean '(1 2 3 4))
;=> 5/2

(std '(1 2 3 4))
;=> 1\.118034

(m+ #(1 2) #(3 4))
;=> #\(4 6\)

(mv* #2A((1 2) (3 4)) #(1 1))
;=> #\(0 0\)

(inner-product #(1 2) #(3 4))
;=> 11

(with-output-to-string (s) (let ((*standard-output* s)) (force-format s "~a!" 1)))
;=> "1!"

(typep nil 'non-null)
;=> NIL

(handler-case (verify-type 3 string) (error () :not-a-string))
;=> :NOT-A-STRING

(handler-case (check-not-null nil) (error () :null))
;=> :NULL

(with-gensyms (a b) (list (symbolp a) (eq a b)))
;=> \(T NIL\)

(let ((v (generate-histogram 1 5))) v)
;=> \(\(1 \. 5\)\)

(hist-count '((1 . 2) (2 . 3)) #'evenp)
;=> 3

(multiple-value-list (quantile '(1 2 3 4 5)))
;=> \(3\)

(asdf:load-system :extended-reals)
;=> T

(in-package :extended-reals)
;=> .*

(e+ 1 2 3)
;=> 6

(e+ 1 'infinity)
;=> INFINITY

(e- 'infinity)
;=> -INFINITY

(e- 5 2 1)
;=> 2

(e* 2 'infinity)
;=> INFINITY

(e* -2 'infinity)
;=> -INFINITY

(handler-case (e+ 'infinity '-infinity) (extended-real-arithmetic-error () :undefined))
;=> :UNDEFINED

(handler-case (e* 0 'infinity) (extended-real-arithmetic-error () :undefined))
;=> :UNDEFINED

(e/ 6 3)
;=> 2

(e/ 'infinity 2)
;=> INFINITY

(emax 1 'infinity 3)
;=> INFINITY

(emin 1 '-infinity 3)
;=> -INFINITY

(emax)
;=> -INFINITY

(emin)
;=> INFINITY

(list (e> 'infinity 3) (e< '-infinity 3) (e>= 3 3) (e<= 'infinity 3))
;=> \(T T T NIL\)

(multiple-value-list (argmax '(3 9 4)))
;=> \(9 1 9\)

(multiple-value-list (argmin '(3 9 4) :key #'identity))
;=> \(3 0 -3\)

(typep 'infinity 'extended-real)
;=> T

(typep "x" 'extended-real)
;=> NIL

(asdf:load-system :data-structures)
;=> T

(in-package :cl-user)
;=> .*

(let ((q (pqueue:make-priority-queue))) (pqueue:enqueue q :a 1) (pqueue:enqueue q :b 5) (pqueue:enqueue q :c 3) (list (pqueue:num-entries q) (multiple-value-list (pqueue:peek-highest q)) (loop until (zerop (pqueue:num-entries q)) collect (pqueue:dequeue-highest q))))
;=> \(3 \(:B 5\) \(:B :C :A\)\)

(handler-case (pqueue:peek-highest (pqueue:make-priority-queue)) (error () :empty))
;=> :EMPTY

(let ((q (pqueue:make-priority-queue))) (pqueue:enqueue q :a 'extended-reals:-infinity) (pqueue:enqueue q :b 0) (pqueue:dequeue-highest q))
;=> :B

(asdf:load-system :cl-graph)
;=> T

(in-package :cl-graph)
;=> .*

(defparameter *g* (make-undirected-graph '((0 1 2) (1 2) (2 3) (3))))
;=> \*G\*

(sort (copy-list (node-list *g*)) #'<)
;=> \(0 1 2 3\)

(length (edge-list *g*))
;=> 4

(sort (copy-list (neighbors *g* 2)) #'<)
;=> \(0 1 3\)

(not (null (edge-between *g* 0 1)))
;=> T

(edge-between *g* 0 3)
;=> NIL

(defparameter *d* (make-graph))
;=> \*D\*

(list (add-node *d* :id 1 :data '((:name . "a"))) (add-node *d* :id 2) (add-node *d* :id 3))
;=> \(1 2 3\)

(add-edge *d* 1 2 :id 12 :data '((:length . 5)))
;=> 12

(add-edge *d* 2 3 :id 23 :data '((:length . 7)))
;=> 23

(list (tail *d* 12) (head *d* 12))
;=> \(1 2\)

(get-node-data *d* 1)
;=> \(\(:NAME \. "a"\)\)

(lookup-edge-data *d* :length 12)
;=> 5

(outgoing-edges *d* 2)
;=> \(23\)

(incoming-edges *d* 2)
;=> \(12\)

(other-node *d* 12 1)
;=> 2

(incident-nodes *d* 12)
;=> \(1 2\)

(shortest-path-distance *d* 1 3)
;=> 12\.0

(shortest-path *d* 3 1)
;=> \(12 23\)

(progn (update-edge-data *d* 12 :length 6) (lookup-edge-data *d* :length 12))
;=> 6

(progn (remove-edge *d* 23) (edge-list *d*))
;=> \(12\)

(progn (remove-node *d* 3) (sort (copy-list (node-list *d*)) #'<))
;=> \(1 2\)

(handler-case (add-node *d* :id 1) (error () :there))
;=> :THERE

(sort (copy-list (node-list (copy-graph *d*))) #'<)
;=> \(1 2\)

(defparameter *t* (make-graph))
;=> \*T\*

(progn (add-node *t* :id 0) (add-child *t* 0) (add-child *t* 0) (add-child *t* 1) (list (root *t*) (depth *t* 3) (parent *t* 3) (sort (copy-list (children *t* 0)) #'<) (is-leaf *t* 2) (is-root *t* 0)))
;=> \(0 2 1 \(1 2\) T T\)

(is-tree *t*)
;=> T

(asdf:load-system :cl-probability)
;=> T

(in-package :cl-prob)
;=> .*

(probability '((1 . 0.25) (2 . 0.75)) #'evenp)
;=> 0\.75

(expectation '((1 . 0.25) (2 . 0.75)) #'identity)
;=> 1\.75

(condition-on-event '((1 . 0.25) (2 . 0.25) (3 . 0.5)) #'oddp)
;=> \(\(1 \. 0\.33333334\) \(3 \. 0\.6666667\)\)

(normalize-alist! (list (cons :a 1) (cons :b 3)))
;=> \(\(:A \. 1/4\) \(:B \. 3/4\)\)

(probability #(0.25 0.75) #'zerop)
;=> 0\.25

(expectation #(0.5 0.5) #'1+)
;=> 1\.5

(sample '((:only . 1.0)))
;=> :ONLY

(exponential-cdf 1.0 0.5)
;=> 0\.39346933

(> (sample-exponential 2.0) 0)
;=> T
