;;;; Operators: what actions need and change.

(in-package #:courier-plans)

(defstruct operator
  name parameters preconditions add delete (cost 1))

(defvar *operators* (make-hash-table))

(defmacro defoperator (name (&rest parameters) &key preconditions add delete (cost 1))
  "Define an operator.  COST is a form in which the parameters are bound, without their question marks."
  (let ((plain (mapcar (lambda (parameter) (intern (subseq (string parameter) 1))) parameters)))
    `(setf (gethash ',name *operators*)
           (make-operator :name ',name :parameters ',parameters :preconditions ',preconditions
                          :add ',add :delete ',delete
                          :cost ,(if (numberp cost) cost `(lambda ,plain (declare (ignorable ,@plain)) ,cost))))))

(defoperator open-it (?place)
  :preconditions ((closed ?place))
  :add ((opened ?place))
  :delete ((closed ?place)))

(defoperator close-it (?place)
  :preconditions ((opened ?place) (robot-at ?place))
  :add ((closed ?place))
  :delete ((opened ?place)))

(defoperator go-to (?place)
  :preconditions ((robot-at ?from))
  :add ((robot-at ?place))
  :delete ((robot-at ?from))
  :cost (if (eq place 'fridge) 3 2))

(defoperator pick-up (?thing ?place)
  :preconditions ((in ?thing ?place) (robot-at ?place) (hand-empty) (not (closed ?place)))
  :add ((holding ?thing))
  :delete ((in ?thing ?place) (hand-empty)))

(defoperator put-down (?thing ?place)
  :preconditions ((holding ?thing) (robot-at ?place) (not (closed ?place)))
  :add ((in ?thing ?place) (hand-empty))
  :delete ((holding ?thing)))

(define-condition not-applicable (error)
  ((step :initarg :step :reader not-applicable-step)
   (missing :initarg :missing :reader missing-facts))
  (:report (lambda (condition stream)
             (format stream "~(~S~) cannot be done: ~{~(~S~)~^, ~} ~:[do~;does~] not hold."
                     (not-applicable-step condition) (missing-facts condition)
                     (= 1 (length (missing-facts condition)))))))

(defun step-operator (step)
  (or (gethash (first step) *operators*) (error "There is no operator ~S." (first step))))

(defun step-bindings (step)
  (pairlis (operator-parameters (step-operator step)) (rest step)))

(defun missing (step facts)
  (loop for condition in (operator-preconditions (step-operator step))
        when (null (match-all (list condition) facts (step-bindings step)))
          collect (substitute-bindings (step-bindings step) condition)))

(defun applicable-p (step facts) (endp (missing step facts)))

(defun apply-operator (step facts)
  "FACTS after STEP."
  (let* ((operator (step-operator step))
         (all (match-all (operator-preconditions operator) facts (step-bindings step))))
    (when (null all)
      (error 'not-applicable :step step :missing (missing step facts)))
    (flet ((instantiate (patterns) (substitute-bindings (first all) patterns)))
      (let ((gone (instantiate (operator-delete operator))))
        (reduce (lambda (facts fact) (adjoin fact facts :test #'equal))
                (instantiate (operator-add operator))
                :initial-value (remove-if (lambda (fact) (member fact gone :test #'equal)) facts))))))

(defun step-cost (step)
  (let ((cost (operator-cost (step-operator step))))
    (etypecase cost
      (number cost)
      (function (apply cost (rest step))))))

(defun facts (&optional (world *world*) (at 'table))
  "WORLD as a list of facts."
  (let ((*world* world))
    (append (list (list 'robot-at at) '(hand-empty))
            (loop for thing in (objects-of 'movable)
                  for place = (location-of (name thing))
                  when place
                    collect `(in ,(name thing) ,place))
            (loop for place in (objects-of 'openable)
                  collect (list (if (open-p place) 'opened 'closed) (name place))))))
