;;;; Hierarchical tasks: a task is an operator, or is taken apart by the first of its methods that leads to a plan.

(in-package #:courier-plans)

(defvar *tasks* (make-hash-table :test #'eq))
(defvar *depth* 0)
(defparameter *planning-trace* nil "A stream, or NIL.")

(define-condition no-plan (error)
  ((task :initarg :task :reader no-plan-task))
  (:report (lambda (condition stream)
             (format stream "No method of ~(~A~) works for ~:(~{~A~^, ~}~)."
                     (first (no-plan-task condition)) (rest (no-plan-task condition))))))

(defstruct (task-method (:type list) :named)
  pattern conditions subtasks)

(defmacro define-task (name (&rest parameters) &body methods)
  "Each of METHODS is (:when conditions :do subtasks)."
  `(setf (gethash ',name *tasks*)
         (list ,@(loop for method in methods
                       collect (destructuring-bind (&key ((:when conditions)) ((:do subtasks))) method
                                 `(make-task-method :pattern '(,name ,@parameters)
                                                    :conditions ',conditions
                                                    :subtasks ',subtasks))))))

(define-task be-at (?place)
  (:when ((robot-at ?place)) :do ())
  (:when () :do ((go-to ?place))))

(define-task accessible (?place)
  (:when ((not (closed ?place))) :do ())
  (:when () :do ((be-at ?place) (open-it ?place))))

(define-task hold (?thing)
  (:when ((holding ?thing)) :do ())
  (:when ((in ?thing ?place)) :do ((be-at ?place) (accessible ?place) (pick-up ?thing ?place))))

(define-task bring (?thing ?goal)
  (:when ((in ?thing ?goal)) :do ())
  (:when ((not (closed ?goal)) (in ?thing ?place) (not (closed ?place)))
   :do ((hold ?thing) (be-at ?goal) (put-down ?thing ?goal)))
  (:when () :do ((accessible ?goal) (hold ?thing) (be-at ?goal) (put-down ?thing ?goal))))

(define-task all-closed (?*)
  (:when ((opened ?place)) :do ((be-at ?place) (close-it ?place) (all-closed)))
  (:when () :do ()))

(defun trace-line (control &rest arguments)
  (when *planning-trace*
    (format *planning-trace* "~&~V@T~?~%" (* 2 *depth*) control arguments)))

(defun seek-plan (tasks facts)
  "The steps for TASKS and the facts after them; a second value of NIL means that there are none."
  (if (endp tasks)
      (values '() facts t)
      (destructuring-bind (task &rest others) tasks
        (if (gethash (first task) *operators*)
            (handler-case (apply-operator task facts)
              (not-applicable (condition)
                (trace-line "~(~A~) fails: ~A" task condition)
                (values nil nil nil))
              (:no-error (after)
                (multiple-value-bind (steps end found) (seek-plan others after)
                  (if found (values (cons task steps) end t) (values nil nil nil)))))
            (let ((methods (gethash (first task) *tasks*)))
              (unless methods (error "Nobody knows how to ~(~A~)." (first task)))
              (trace-line "~(~A~)" task)
              (dolist (method methods (values nil nil nil))
                (multiple-value-bind (bindings matched) (match (task-method-pattern method) task)
                  (when matched
                    (dolist (choice (match-all (task-method-conditions method) facts bindings))
                      (let ((*depth* (1+ *depth*)))
                        (multiple-value-bind (steps end found)
                            (seek-plan (append (substitute-bindings choice (task-method-subtasks method)) others) facts)
                          (when found
                            (return-from seek-plan (values steps end t))))))))))))))

(defun plan-for (tasks &optional (facts (facts)))
  (loop with plan = '() and now = facts
        for task in tasks
        do (multiple-value-bind (steps end found) (seek-plan (list task) now)
             (unless found
               (restart-case (error 'no-plan :task task)
                 (skip-task () :report (lambda (stream) (format stream "Plan without ~(~A~)." task))
                   (setf steps '() end now))))
             (setf now end
                   plan (append plan steps)))
        finally (return (values plan (reduce #'+ plan :key #'step-cost) now))))
