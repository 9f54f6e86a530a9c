;;;; Functions made of functions.

(in-package #:alexandria)

(declaim (inline ensure-function))
(defun ensure-function (function-designator)
  "The function that FUNCTION-DESIGNATOR means."
  (if (functionp function-designator) function-designator (fdefinition function-designator)))

(defun curry (function &rest arguments)
  "FUNCTION with its first ARGUMENTS given."
  (let ((function (ensure-function function)))
    (lambda (&rest more) (apply function (append arguments more)))))

(defun rcurry (function &rest arguments)
  "FUNCTION with its last ARGUMENTS given."
  (let ((function (ensure-function function)))
    (lambda (&rest more) (apply function (append more arguments)))))

(defun compose (function &rest more-functions)
  "The last function gets the arguments, each other one the primary value of the one after it."
  (reduce (lambda (outer inner)
            (let ((outer (ensure-function outer)) (inner (ensure-function inner)))
              (lambda (&rest arguments) (funcall outer (apply inner arguments)))))
          more-functions :initial-value (ensure-function function)))

(defun multiple-value-compose (function &rest more-functions)
  "The last function gets the arguments, each other one all values of the one after it."
  (reduce (lambda (outer inner)
            (let ((outer (ensure-function outer)) (inner (ensure-function inner)))
              (lambda (&rest arguments) (multiple-value-call outer (apply inner arguments)))))
          more-functions :initial-value (ensure-function function)))

(defun conjoin (predicate &rest more-predicates)
  "A predicate: whether all hold; its value is that of the last one."
  (if (null more-predicates)
      predicate
      (let ((predicates (mapcar #'ensure-function (cons predicate more-predicates))))
        (lambda (&rest arguments)
          (loop for (test . more) on predicates
                if more do (unless (apply test arguments) (return nil))
                else do (return (apply test arguments)))))))

(defun disjoin (predicate &rest more-predicates)
  "A predicate: whether one holds; its value is that of the first that does."
  (let ((predicates (mapcar #'ensure-function (cons predicate more-predicates))))
    (lambda (&rest arguments)
      (loop for (test . more) on predicates
            if more do (let ((value (apply test arguments))) (when value (return value)))
            else do (return (apply test arguments))))))

;;; ------------------------------------------------------------------------------------------------------- compiler macros

(define-compiler-macro curry (function &rest arguments)
  (let ((variable (gensym "FUNCTION")) (names (make-gensym-list (length arguments) "ARGUMENT")))
    `(let ((,variable (ensure-function ,function)) ,@(mapcar #'list names arguments))
       (lambda (&rest more) (apply ,variable ,@names more)))))

(defun composition-form (functions call)
  "The lambda expression of a composition of the forms FUNCTIONS, each evaluated once; CALL is the operator for the outer ones."
  (let ((names (make-gensym-list (length functions) "FUNCTION")))
    `(let ,(mapcar (lambda (name function) `(,name (ensure-function ,function))) names functions)
       (lambda (&rest arguments)
         ,(reduce (lambda (name inner) `(,call ,name ,inner)) names
                  :end (1- (length names)) :from-end t :initial-value `(apply ,(car (last names)) arguments))))))

(define-compiler-macro compose (function &rest more-functions)
  (composition-form (cons function more-functions) 'funcall))

(define-compiler-macro multiple-value-compose (function &rest more-functions)
  (composition-form (cons function more-functions) 'multiple-value-call))
