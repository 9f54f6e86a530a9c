;;;; Patterns with variables ?x, matched against data.

(in-package #:courier-plans)

(defun variable-p (thing)
  (and (symbolp thing) (plusp (length (symbol-name thing))) (char= #\? (char (symbol-name thing) 0))))

(deftype pattern-variable () '(satisfies variable-p))

(defun match (pattern data &optional (bindings '()))
  "The bindings that make PATTERN equal to DATA, and true; (?is test x) asks a predicate, ?* matches a rest."
  (typecase pattern
    (pattern-variable
     (let ((known (assoc pattern bindings)))
       (cond ((null known) (values (acons pattern data bindings) t))
             ((equal (cdr known) data) (values bindings t))
             (t (values nil nil)))))
    ((cons (eql ?is))
     (destructuring-bind (test inner) (rest pattern)
       (if (funcall test data) (match inner data bindings) (values nil nil))))
    ((cons (eql ?*) null) (values bindings (listp data)))
    ((cons (eql ?*) (cons t null)) (match (second pattern) data bindings))
    (cons
     (if (atom data)
         (values nil nil)
         (multiple-value-bind (inner matched) (match (car pattern) (car data) bindings)
           (if matched (match (cdr pattern) (cdr data) inner) (values nil nil)))))
    (t (if (equal pattern data) (values bindings t) (values nil nil)))))

(defun substitute-bindings (bindings form)
  (sublis bindings form))

(defun match-all (patterns facts &optional (bindings '()))
  "All bindings under which every one of PATTERNS is among FACTS; (not p) holds if P matches none."
  (if (endp patterns)
      (list bindings)
      (destructuring-bind (pattern . others) patterns
        (if (and (consp pattern) (eq (first pattern) 'not))
            (unless (some (lambda (fact) (nth-value 1 (match (second pattern) fact bindings))) facts)
              (match-all others facts bindings))
            (loop for fact in facts
                  nconc (multiple-value-bind (inner matched) (match pattern fact bindings)
                          (when matched (match-all others facts inner))))))))
