;;;; Numbers about runs, and every kind of LOOP.

(in-package #:courier-plans)

(defun mean (numbers)
  (loop for number in numbers
        sum number into total
        count t into n
        finally (return (if (zerop n) 0 (/ total n)))))

(defun deviation (numbers &aux (mean (mean numbers)))
  (sqrt (coerce (mean (mapcar (lambda (number) (expt (- number mean) 2)) numbers)) 'double-float)))

(defun histogram (things &key (key #'identity) (test #'equal))
  (let ((table (make-hash-table :test test)))
    (map nil (lambda (thing) (incf (gethash (funcall key thing) table 0))) things)
    (stable-sort (loop for key being the hash-keys of table using (hash-value count)
                       collect (cons key count))
                 #'> :key #'cdr)))

(defun summary (log)
  (loop with first = nil
        for event across (events log)
        for time = (event-time event)
        initially (setf first :none)
        when (eq first :none)
          do (setf first time)
        maximize time into last
        minimize time into start
        count (eq (event-kind event) :failure) into failures
        if (eq (event-kind event) :start)
          collect (first (event-what event)) into actions
          and count t into starts
        else if (member (event-kind event) '(:retry :note))
          append (list (event-kind event)) into others
        end
        finally (return (list :from start :to last :failures failures :starts starts :first first
                              :actions (histogram actions :test #'eq) :others (histogram others)))))

(defmethod statistics ((numbers list))
  (list :mean (mean numbers) :least (loop for n in numbers minimize n) :most (loop for n in numbers maximize n)
        :all-positive (loop for n in numbers always (plusp n))
        :first-even (loop for n in numbers thereis (and (evenp n) n))
        :no-zero (loop for n in numbers never (zerop n))))

(defmethod statistics ((numbers vector))
  (statistics (coerce numbers 'list)))

(defun loops ()
  "LOOP in its many ways, as one list."
  (list (loop for i from 10 downto 1 by 3 collect i)
        (loop for x in '(a b c d) by #'cddr for i upfrom 1 collect (cons x i))
        (loop for (a (b . c) nil . d) in '((1 (2 . 3) 4 5 6) (7 (8) 9)) collect (list a b c d))
        (loop repeat 3 for char across "abcdef" collect char)
        (loop for (key value) on '(:a 1 :b 2) by #'cddr nconc (list value key))
        (loop with (a b) = '(1 2) and c = 3 for x = a then (+ x b c) while (< x 20) collect x)
        (loop for x = 1 then (* 2 x) until (> x 100) sum x of-type fixnum)
        (loop for i of-type fixnum below 10 when (evenp i) collect i into even else collect i into odd
              finally (return (list even odd)))
        (loop named outer for i from 1 do (loop for j from 1 to i when (= 12 (* i j)) do (return-from outer (list i j))))
        (let ((table (make-hash-table)))
          (setf (gethash :one table) 1)
          (loop for value being each hash-value of table using (hash-key key) collect (list key value)))
        (loop for symbol being the external-symbols of :courier-costmap count symbol)
        (loop for x in '(3 1 2) for y = (* x x) unless (= x 1) maximize y into most and minimize y into least
              finally (return (values (list most least))))
        (loop for a in '(1 2 3) and previous = 0 then a collect (- a previous))
        (loop as word in '("x" "yy" "zzz") collecting (length word) appending (list word))
        (loop for sub on '(1 2 . 3) collect (if (consp sub) (car sub) sub))
        (block nil (loop (return :simple)))
        (let ((n 0)) (loop (incf n) (when (> n 4) (return n))))
        (loop for i from 0 for x across #(5 6 7) do (progn) collect (* i x) finally (setf i 100))))
