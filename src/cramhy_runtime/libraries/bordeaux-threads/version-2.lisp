;;;; Bordeaux-Threads, version 2 of its interface: threads, locks, condition variables, semaphores, atomic integers. Names, lambda lists
;;;; and results are those of bordeaux-threads 0.9; the code is cramhy's own, on SB-THREAD.

(defpackage #:bordeaux-threads-2
  (:use #:common-lisp)
  (:nicknames #:bt2)
  (:import-from #:sb-thread #:thread #:thread-name #:thread-alive-p #:semaphore)
  (:import-from #:sb-ext #:timeout)
  (:export
   #:*supports-threads-p* #:*default-special-bindings* #:*standard-io-bindings* #:abnormal-exit #:abnormal-exit-condition
   #:acquire-lock #:acquire-recursive-lock #:all-threads #:atomic-integer #:atomic-integer-compare-and-swap #:atomic-integer-decf
   #:atomic-integer-incf #:atomic-integer-value #:bordeaux-threads-error #:condition-broadcast #:condition-notify
   #:condition-variable #:condition-variable-p #:condition-wait #:current-thread #:destroy-thread #:error-in-thread
   #:interrupt-thread #:join-thread #:keyarg-not-supported #:lock #:lock-name #:lockp #:make-atomic-integer
   #:make-condition-variable #:make-lock #:make-recursive-lock #:make-semaphore #:make-thread #:native-lock #:native-lock-p
   #:native-recursive-lock-p #:not-implemented #:recursive-lock #:recursive-lock-name #:recursive-lock-p #:release-lock
   #:release-recursive-lock #:semaphore #:semaphorep #:signal-in-thread #:signal-semaphore #:start-multiprocessing #:thread
   #:thread-alive-p #:thread-name #:thread-native-thread #:thread-yield #:threadp #:timeout #:wait-on-semaphore #:warn-in-thread
   #:with-lock-held #:with-recursive-lock-held #:with-timeout))

(in-package #:bordeaux-threads-2)

(defvar *supports-threads-p* t "There are threads: tasks of cramhy's kernel.")

(defvar *default-special-bindings* '()
  "An association list of special variables and forms: what new threads bind the variables to, besides :INITIAL-BINDINGS.")

(defparameter *standard-io-bindings*
  '((*package* . (find-package :common-lisp-user)) (*print-array* . t) (*print-base* . 10) (*print-case* . :upcase)
    (*print-circle* . nil) (*print-escape* . t) (*print-gensym* . t) (*print-length* . nil) (*print-level* . nil)
    (*print-lines* . nil) (*print-miser-width* . nil) (*print-pretty* . nil) (*print-radix* . nil) (*print-readably* . nil)
    (*print-right-margin* . nil) (*random-state* . (make-random-state t)) (*read-base* . 10)
    (*read-default-float-format* . 'single-float) (*read-eval* . nil) (*read-suppress* . nil) (*readtable* . (copy-readtable nil)))
  "What WITH-STANDARD-IO-SYNTAX binds, for *DEFAULT-SPECIAL-BINDINGS*.")

(define-condition bordeaux-threads-error (error) ())

(define-condition not-implemented (bordeaux-threads-error) ())

(define-condition keyarg-not-supported (not-implemented) ())

(define-condition abnormal-exit (bordeaux-threads-error)
  ((exit-condition :initarg :condition :initform :terminated :reader abnormal-exit-condition))
  (:report (lambda (condition stream)
             (format stream "Thread exited with condition: ~A" (abnormal-exit-condition condition)))))

;;; ------------------------------------------------------------------------------------------------------------- threads

(defun bound-function (function bindings)
  "FUNCTION, which the new thread calls while the variables of BINDINGS are bound to the values of their forms."
  (let ((all (append bindings *default-special-bindings*)))
    (if (null all)
        function
        (lambda ()
          (progv (mapcar #'car all) (mapcar (lambda (binding) (eval (cdr binding))) all)
            (funcall function))))))

(defvar *failures* (make-hash-table :test 'eq :weakness :key) "Thread -> the condition that ended it.")

(defun make-thread (function &key (name "Anonymous thread") (initial-bindings '()) (trap-conditions nil))
  "A new thread that calls FUNCTION. With TRAP-CONDITIONS an error ends it silently; who joins it hears of it."
  (let ((body (bound-function function initial-bindings)))
    (sb-thread:make-thread
     (if trap-conditions
         (lambda ()
           (handler-case (funcall body)
             (condition (problem)
               (setf (gethash sb-thread:*current-thread* *failures*) problem)
               (sb-thread:abort-thread))))
         body)
     :name name)))

(defun current-thread ()
  "The thread that runs."
  sb-thread:*current-thread*)

(defun threadp (object)
  "Whether OBJECT is a thread."
  (typep object 'thread))

(defun thread-native-thread (thread)
  "The thread itself."
  thread)

(defun all-threads ()
  "A list of all living threads."
  (sb-thread:list-all-threads))

(defun join-thread (thread)
  "The values of THREAD's function, when it has ended. A thread that did not end by returning is an ABNORMAL-EXIT."
  (handler-case (sb-thread:join-thread thread)
    (sb-thread:join-thread-error (problem)
      (multiple-value-bind (condition there-is-one) (gethash thread *failures*)
        (cond (there-is-one (error 'abnormal-exit :condition condition))
              ((eq thread sb-thread:*current-thread*) (error problem))
              (t (error 'abnormal-exit)))))))

(defun thread-yield ()
  "Let others run first."
  (sb-thread:thread-yield)
  (values))

(defun refuse-myself (thread what)
  (when (eq thread sb-thread:*current-thread*)
    (error "Cannot ~A the current thread." what)))

(defun interrupt-thread (thread function &rest arguments)
  "Have THREAD call FUNCTION at its next waiting point. Returns THREAD."
  (sb-thread:interrupt-thread thread (lambda () (apply function arguments)))
  thread)

(defun signal-in-thread (thread datum &rest arguments)
  "Signal a condition in THREAD."
  (apply #'interrupt-thread thread #'signal datum arguments))

(defun warn-in-thread (thread datum &rest arguments)
  "Warn in THREAD."
  (apply #'interrupt-thread thread #'warn datum arguments))

(defun error-in-thread (thread datum &rest arguments)
  "Signal an error in THREAD."
  (apply #'interrupt-thread thread #'error datum arguments))

(defun destroy-thread (thread)
  "Make THREAD unwind and end. Returns THREAD."
  (refuse-myself thread "destroy")
  (sb-thread:terminate-thread thread)
  thread)

(defun start-multiprocessing ()
  "There is nothing to start."
  (values))

;;; --------------------------------------------------------------------------------------------------------------- locks

(deftype lock () 'sb-thread:mutex)
(deftype native-lock () 'sb-thread:mutex)

(defun make-lock (&key name)
  "A lock that its holder cannot take again."
  (sb-thread:make-mutex :name name))

(defun lockp (object)
  "Whether OBJECT is a lock."
  (typep object 'sb-thread:mutex))

(defun native-lock-p (object)
  "Whether OBJECT is a lock."
  (lockp object))

(defun lock-name (lock)
  "The name of LOCK."
  (sb-thread:mutex-name lock))

(defun acquire-lock (lock &key (wait t) timeout)
  "Take LOCK; T, or NIL if it cannot be had: at once unless WAIT, or in TIMEOUT seconds."
  (sb-thread:grab-mutex lock :waitp wait :timeout timeout))

(defun release-lock (lock)
  "Give LOCK up. Returns LOCK."
  (sb-thread:release-mutex lock)
  lock)

(defmacro with-lock-held ((place &key timeout) &body body)
  "The BODY while the thread has the lock; NIL if it cannot be had in TIMEOUT seconds."
  `(sb-thread:with-mutex (,place :timeout ,timeout) ,@body))

(defstruct (recursive-lock (:constructor new-recursive-lock (mutex)) (:copier nil))
  mutex (depth 0))

(defun make-recursive-lock (&key name)
  "A lock that its holder may take again."
  (new-recursive-lock (sb-thread:make-mutex :name name)))

(defun native-recursive-lock-p (object)
  "Whether OBJECT is a recursive lock."
  (recursive-lock-p object))

(defun recursive-lock-name (lock)
  "The name of LOCK."
  (sb-thread:mutex-name (recursive-lock-mutex lock)))

(defun acquire-recursive-lock (lock &key (wait t) timeout)
  "Take LOCK, once more if the thread has it; T, or NIL if it cannot be had."
  (let ((mutex (recursive-lock-mutex lock)))
    (when (or (sb-thread:holding-mutex-p mutex) (sb-thread:grab-mutex mutex :waitp wait :timeout timeout))
      (incf (recursive-lock-depth lock))
      t)))

(defun release-recursive-lock (lock)
  "Undo one ACQUIRE-RECURSIVE-LOCK. Returns LOCK."
  (when (sb-thread:holding-mutex-p (recursive-lock-mutex lock))
    (when (zerop (decf (recursive-lock-depth lock)))
      (sb-thread:release-mutex (recursive-lock-mutex lock))))
  lock)

(defun call-with-recursive-lock (lock timeout body)
  (when (acquire-recursive-lock lock :timeout timeout)
    (unwind-protect (funcall body)
      (release-recursive-lock lock))))

(defmacro with-recursive-lock-held ((place &key timeout) &body body)
  "The BODY while the thread has the recursive lock; NIL if it cannot be had in TIMEOUT seconds."
  `(call-with-recursive-lock ,place ,timeout (lambda () ,@body)))

;;; -------------------------------------------------------------------------------------------------- condition variables

(deftype condition-variable () 'sb-thread:waitqueue)

(defun make-condition-variable (&key name)
  "Something that threads wait for."
  (sb-thread:make-waitqueue :name name))

(defun condition-variable-p (object)
  "Whether OBJECT is a condition variable."
  (typep object 'sb-thread:waitqueue))

(defun mutex-of (lock)
  (if (recursive-lock-p lock) (recursive-lock-mutex lock) lock))

(defun condition-wait (condition-variable lock &key timeout)
  "Give LOCK up, wait for CONDITION-NOTIFY, and take LOCK again; T, or NIL after TIMEOUT seconds. The thread has LOCK in any case."
  (or (sb-thread:condition-wait condition-variable (mutex-of lock) :timeout timeout)
      (progn (sb-thread:grab-mutex (mutex-of lock))
             nil)))

(defun condition-notify (condition-variable)
  "Wake one of the threads that wait."
  (sb-thread:condition-notify condition-variable))

(defun condition-broadcast (condition-variable)
  "Wake all threads that wait."
  (sb-thread:condition-broadcast condition-variable))

;;; ----------------------------------------------------------------------------------------------------------- semaphores

(defun make-semaphore (&key name (count 0))
  "A semaphore with COUNT units."
  (sb-thread:make-semaphore :name name :count count))

(defun semaphorep (object)
  "Whether OBJECT is a semaphore."
  (typep object 'semaphore))

(defun signal-semaphore (semaphore &key (count 1))
  "Add COUNT units. Returns T."
  (sb-thread:signal-semaphore semaphore count)
  t)

(defun wait-on-semaphore (semaphore &key timeout)
  "Take a unit; T, or NIL after TIMEOUT seconds."
  (if (sb-thread:wait-on-semaphore semaphore :timeout timeout) t nil))

;;; ---------------------------------------------------------------------------------------------- atomic integers, timeouts

(defstruct (atomic-integer (:constructor make-atomic-integer (&key (value 0))) (:copier nil) (:predicate nil))
  (value 0))

(defun atomic-integer-compare-and-swap (atomic-integer old new)
  "Store NEW if the value is OLD; whether it was."
  (when (eql (atomic-integer-value atomic-integer) old)
    (setf (atomic-integer-value atomic-integer) new)
    t))

(defun atomic-integer-incf (atomic-integer &optional (delta 1))
  "Add DELTA. Returns the new value."
  (incf (atomic-integer-value atomic-integer) delta))

(defun atomic-integer-decf (atomic-integer &optional (delta 1))
  "Subtract DELTA. Returns the new value."
  (decf (atomic-integer-value atomic-integer) delta))

(defmacro with-timeout ((timeout) &body body)
  "The BODY; after TIMEOUT seconds the condition TIMEOUT is signalled in it."
  `(sb-ext:with-timeout ,timeout ,@body))
