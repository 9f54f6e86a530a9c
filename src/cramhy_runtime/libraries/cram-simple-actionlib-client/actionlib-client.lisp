;;;; Clients of ROS actions, found by name. A client connects when it is first called, or at once if that is wished, and is forgotten when
;;;; the node ends.

(defpackage #:cram-simple-actionlib-client
  (:use #:common-lisp)
  (:nicknames #:actionlib-client)
  (:export #:make-simple-action-client #:call-simple-action-client))

(in-package #:cram-simple-actionlib-client)

(defstruct entry
  "What is known under a name: the action, its type, the seconds to wait for its server, and the client, once there is one."
  ros-name ros-type timeout client)

(defvar *entries* (make-hash-table)
  "The entry of each name.")

(defun connect (entry)
  "Make the client of ENTRY and wait for its server; nil when none is heard."
  (with-slots (ros-name ros-type timeout client) entry
    (let ((new (actionlib:make-action-client ros-name ros-type)))
      (roslisp:ros-info (simple-actionlib-client) "Waiting for the action server ~A..." ros-name)
      (cond ((actionlib:wait-for-server new timeout) (setf client new))
            (t (roslisp:ros-warn (simple-actionlib-client) "There is no action server ~A after ~A seconds." ros-name timeout)
               nil)))))

(defun connected-client (name)
  "The client that NAME stands for; one that is new has waited for its server. Nil when NAME is not known, or no server was heard."
  (let ((entry (gethash name *entries*)))
    (when entry
      (or (entry-client entry) (connect entry)))))

(defun make-simple-action-client (name ros-name ros-type timeout &key initialize-now)
  "Let NAME, a symbol, stand for a client of the action ROS-NAME of ROS-TYPE, which waits TIMEOUT seconds for the server. With
INITIALIZE-NOW it connects at once, else when it is first called."
  (setf (gethash name *entries*) (make-entry :ros-name ros-name :ros-type ros-type :timeout timeout))
  (when initialize-now (connected-client name))
  name)

(defun call-simple-action-client (name &key action-goal action-timeout)
  "Send ACTION-GOAL, a message, and wait ACTION-TIMEOUT seconds, or without end, for what comes of it: result and status, such as
:SUCCEEDED or :TIMEOUT; nil and nil where there is no client, or no server."
  (let ((client (connected-client name)))
    (if client
        (multiple-value-prog1 (actionlib:call-goal client action-goal :timeout action-timeout :result-timeout action-timeout)
          (roslisp:ros-info (simple-actionlib-client) "The action ~A has finished." name))
        (values nil nil))))

(defun destroy-clients ()
  "Forget the connections, but not what the names stand for."
  (loop for entry being the hash-values of *entries* do (setf (entry-client entry) nil)))

(roslisp-utilities:register-ros-cleanup-function destroy-clients)
