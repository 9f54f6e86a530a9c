;;;; SB-CONCURRENCY: queues, mailboxes and gates between threads. Source: SBCL's manual, chapter "sb-concurrency". Queues are those of CUT.
;;;; Its locks of many readers, FRLOCK, are left out: nothing that CRAM loads asks for them.

(defpackage #:sb-concurrency
  (:use #:common-lisp)
  (:import-from #:cram-utilities #:dequeue #:enqueue #:list-queue-contents #:make-queue #:queue #:queue-count #:queue-empty-p #:queue-name #:queuep)
  (:import-from #:sb-thread #:make-semaphore #:semaphore-count #:signal-semaphore #:try-semaphore #:wait-on-semaphore
                #:make-mutex #:with-mutex #:make-waitqueue #:condition-wait #:condition-broadcast)
  (:export #:dequeue #:enqueue #:list-queue-contents #:make-queue #:queue #:queue-count #:queue-empty-p #:queue-name #:queuep
           #:list-mailbox-messages #:mailbox #:mailbox-count #:mailbox-empty-p #:mailbox-name #:mailboxp #:make-mailbox
           #:receive-message #:receive-message-no-hang #:receive-pending-messages #:send-message
           #:close-gate #:gate #:gate-name #:gate-open-p #:gatep #:make-gate #:open-gate #:wait-on-gate))

(in-package #:sb-concurrency)

;;; ------------------------------------------------------------------------------------------------------------- mailboxes

(defstruct (mailbox (:constructor %make-mailbox (name queue semaphore)) (:predicate mailboxp) (:copier nil))
  "A queue of messages on which threads wait. The semaphore counts the messages."
  name queue semaphore)

(defun make-mailbox (&key name initial-contents)
  "A mailbox called NAME that holds the elements of the sequence INITIAL-CONTENTS."
  (%make-mailbox name (make-queue :initial-contents initial-contents) (make-semaphore :count (length initial-contents))))

(defun mailbox-count (mailbox)
  "How many messages MAILBOX holds."
  (queue-count (mailbox-queue mailbox)))

(defun mailbox-empty-p (mailbox)
  (zerop (mailbox-count mailbox)))

(defun list-mailbox-messages (mailbox)
  "The messages in MAILBOX, the oldest first. They stay there."
  (list-queue-contents (mailbox-queue mailbox)))

(defun send-message (mailbox message)
  "Add MESSAGE to MAILBOX; a thread that waits on it goes on."
  (enqueue message (mailbox-queue mailbox))
  (signal-semaphore (mailbox-semaphore mailbox))
  (values))

(defun receive-message (mailbox &key timeout)
  "The oldest message of MAILBOX, and T. Waits for one: TIMEOUT seconds at most, then the values are NIL and NIL."
  (if (wait-on-semaphore (mailbox-semaphore mailbox) :timeout timeout)
      (dequeue (mailbox-queue mailbox))
      (values nil nil)))

(defun receive-message-no-hang (mailbox)
  "The oldest message of MAILBOX, and T; NIL and NIL if there is none."
  (if (try-semaphore (mailbox-semaphore mailbox)) (dequeue (mailbox-queue mailbox)) (values nil nil)))

(defun receive-pending-messages (mailbox &optional n)
  "The list of the messages that are in MAILBOX, N of them at most."
  (loop repeat (if n (min n (mailbox-count mailbox)) (mailbox-count mailbox))
        collect (receive-message-no-hang mailbox)))

(defmethod print-object ((mailbox mailbox) stream)
  (print-unreadable-object (mailbox stream :type t :identity t)
    (format stream "~@[~S ~](~D msgs pending)" (mailbox-name mailbox) (mailbox-count mailbox))))

;;; ----------------------------------------------------------------------------------------------------------------- gates

(defstruct (gate (:constructor %make-gate (name open)) (:predicate gatep) (:copier nil))
  "What threads wait on until it is open."
  name open (mutex (make-mutex)) (waitqueue (make-waitqueue)))

(defun make-gate (&key name open)
  (%make-gate name (and open t)))

(defun gate-open-p (gate)
  (gate-open gate))

(defun open-gate (gate)
  "Open GATE: all threads that wait on it go on. T if it was closed."
  (with-mutex ((gate-mutex gate))
    (let ((closed (not (gate-open gate))))
      (when closed
        (setf (gate-open gate) t)
        (condition-broadcast (gate-waitqueue gate)))
      closed)))

(defun close-gate (gate)
  "Close GATE. T if it was open."
  (with-mutex ((gate-mutex gate))
    (prog1 (gate-open gate)
      (setf (gate-open gate) nil))))

(defun wait-on-gate (gate &key timeout)
  "Wait until GATE is open, TIMEOUT seconds at most. T, or NIL when the time is over."
  (with-mutex ((gate-mutex gate))
    (loop until (gate-open gate)
          do (unless (condition-wait (gate-waitqueue gate) (gate-mutex gate) :timeout timeout)
               (return nil))
          finally (return t))))
