;;;; Bordeaux-Threads, version 1 of its interface, which most programs use: what differs from version 2 are lambda lists.

(defpackage #:bordeaux-threads
  (:use #:common-lisp)
  (:nicknames #:bt)
  (:import-from #:bordeaux-threads-2
                #:*supports-threads-p* #:*default-special-bindings* #:*standard-io-bindings* #:thread #:current-thread #:threadp
                #:thread-name #:all-threads #:interrupt-thread #:destroy-thread #:thread-alive-p #:thread-yield
                #:start-multiprocessing #:lock #:lockp #:release-lock #:with-lock-held #:recursive-lock #:recursive-lock-p
                #:release-recursive-lock #:with-recursive-lock-held #:make-condition-variable #:condition-wait #:condition-notify
                #:condition-broadcast #:semaphore #:semaphorep #:make-semaphore #:signal-semaphore #:wait-on-semaphore
                #:with-timeout #:timeout)
  (:export
   #:*default-special-bindings* #:*standard-io-bindings* #:*supports-threads-p* #:acquire-lock #:acquire-recursive-lock
   #:all-threads #:condition-broadcast #:condition-notify #:condition-wait #:current-thread #:destroy-thread #:interrupt-thread
   #:join-thread #:lock #:lock-p #:lockp #:make-condition-variable #:make-lock #:make-recursive-lock #:make-semaphore #:make-thread
   #:recursive-lock #:recursive-lock-p #:release-lock #:release-recursive-lock #:semaphore #:semaphore-p #:semaphorep
   #:signal-semaphore #:start-multiprocessing #:thread #:thread-alive-p #:thread-name #:thread-yield #:threadp #:timeout
   #:wait-on-semaphore #:with-lock-held #:with-recursive-lock-held #:with-timeout))

(in-package #:bordeaux-threads)

(defun make-thread (function &key (name "Anonymous thread") (initial-bindings '()))
  "A new thread that calls FUNCTION, while the variables of INITIAL-BINDINGS are bound to the values of their forms."
  (bordeaux-threads-2:make-thread function :name name :initial-bindings initial-bindings))

(defun join-thread (thread)
  "The values of THREAD's function, when it has ended; an error if it did not end by returning."
  (sb-thread:join-thread thread))

(defun make-lock (&optional name)
  "A lock that its holder cannot take again."
  (sb-thread:make-mutex :name (or name "Anonymous lock")))

(defun lock-p (object)
  "Whether OBJECT is a lock."
  (lockp object))

(defun acquire-lock (lock &optional (wait-p t))
  "Take LOCK; T, or NIL if it cannot be had at once and WAIT-P is NIL."
  (bordeaux-threads-2:acquire-lock lock :wait wait-p))

(defun make-recursive-lock (&optional name)
  "A lock that its holder may take again."
  (bordeaux-threads-2:make-recursive-lock :name (or name "Anonymous recursive lock")))

(defun acquire-recursive-lock (lock &optional (wait-p t))
  "Take LOCK, once more if the thread has it."
  (bordeaux-threads-2:acquire-recursive-lock lock :wait wait-p))

(defun semaphore-p (object)
  "Whether OBJECT is a semaphore."
  (semaphorep object))

(pushnew :thread-support *features*)
(pushnew :bordeaux-threads *features*)
