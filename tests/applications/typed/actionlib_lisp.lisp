(progn (asdf:load-system :actionlib) (asdf:load-system :actionlib-lisp) (asdf:load-system :actionlib-msg))
;=> T

(progn (defpackage :counting (:use :cl :roslisp :actionlib-lisp)) (in-package :counting))
;=> #<PACKAGE "COUNTING">

(start-ros-node "counting")
;=> 0

(defvar *heard* nil)
;=> \*HEARD\*

(actionlib:def-exec-callback count-down (goal) (dotimes (i 3) (actionlib:publish-feedback :feedback (- goal i)) (wait-duration 0.1)) (cond ((< goal 0) (actionlib:abort-current :result -1)) ((= goal 99) (loop until (actionlib:cancel-request-received) do (wait-duration 0.1)) (actionlib:preempt-current :result 0)) (t (actionlib:succeed-current :result (* 2 goal)))))
;=> COUNT-DOWN

(progn (actionlib:start-action-server "count" "actionlib/TestAction" #'count-down :separate-thread t) (wait-duration 0.5) 'started)
;=> STARTED

(defvar *client* (make-simple-action-client "count" "actionlib/TestAction"))
;=> \*CLIENT\*

(list (type-of *client*) (wait-for-server *client* 5) (is-connected *client*))
;=> \(SIMPLE-ACTION-CLIENT T T\)

(handler-case (state *client*) (error (e) (list (typep e 'simple-error) (princ-to-string e))))
;=> \(T "The client tracks no goal\."\)

(handler-case (wait-for-result *client* 1) (error (e) (princ-to-string e)))
;=> "The client tracks no goal\."

(handler-case (cancel-goal *client*) (error (e) (princ-to-string e)))
;=> "The client tracks no goal\."

(type-of (make-action-goal-msg *client* :goal 7))
;=> ACTIONLIB-MSG:TESTGOAL

(send-goal-and-wait *client* (make-action-goal-msg *client* :goal 7) 5 5)
;=> :SUCCEEDED

(list (state *client*) (actionlib-msg:result (result *client*)))
;=> \(:SUCCEEDED 14\)

(send-goal *client* (make-action-goal-msg *client* :goal 5) :feedback-cb (lambda (message) (push (actionlib-msg:feedback message) *heard*)) :active-cb (lambda () (push :active *heard*)) :done-cb (lambda (state message) (push (list state (actionlib-msg:result message)) *heard*)))
;=> T

; The original calls done-cb again with each report of the server; here it is called once (docs/differences.md).
(list (wait-for-result *client* 5) (progn (wait-duration 0.5) (reverse (remove :active *heard*))))
;=> \(T \(5 4 3 \(:SUCCEEDED 10\)\)\)
;~> \(T \(5 4 3 \(:SUCCEEDED 10\) \(:SUCCEEDED 10\) \(:SUCCEEDED 10\)\)\)

(list (not (null (member :active *heard*))) (state *client*))
;=> \(T :SUCCEEDED\)

(send-goal-and-wait *client* (make-action-goal-msg *client* :goal 99) 1 5)
;=> :PREEMPTED

(list (state *client*) (progn (wait-duration 0.5) (actionlib-msg:result (result *client*))))
;=> \(:PREEMPTED 0\)

(send-goal *client* (make-action-goal-msg *client* :goal 99))
;=> T

(list (wait-for-result *client* 0.7) (state *client*) (result *client*))
;=> \(NIL :ACTIVE NIL\)

(progn (cancel-goal *client*) (wait-duration 1) (list (state *client*) (actionlib-msg:result (result *client*))))
;=> \(:PREEMPTED 0\)

(list (wait-for-result *client* 1) (stop-tracking-goal *client*))
;=> \(T T\)

(handler-case (result *client*) (error (e) (princ-to-string e)))
;=> "The client tracks no goal\."

; The original waits on for a goal that was aborted, and gives NIL; here it is finished (docs/differences.md).
(progn (send-goal *client* (make-action-goal-msg *client* :goal -4)) (wait-for-result *client* 1.5))
;=> T
;~> NIL

(list (state *client*) (actionlib-msg:result (result *client*)))
;=> \(:ABORTED -1\)

(progn (send-goal *client* (make-action-goal-msg *client* :goal 99)) (wait-duration 0.6) (cancel-all-goals *client*) (wait-duration 1) (state *client*))
;=> :PREEMPTED

(handler-case (make-simple-action-client "count" "actionlib/Test") (error (e) (princ-to-string e)))
;=> "The action type is invalid\. Actions always have the suffix 'Action'"

(let ((nobody (make-simple-action-client "nobody" "actionlib/TestAction"))) (list (wait-for-server nobody 0.5) (is-connected nobody)))
;=> \(NIL NIL\)

(defvar *many* (actionlib-lisp::make-action-client "count" "actionlib/TestAction"))
;=> \*MANY\*

(list (type-of *many*) (wait-for-server *many* 5))
;=> \(ACTIONLIB-LISP::ACTION-CLIENT T\)

(progn (setf *heard* nil) (defvar *handle* (send-goal *many* (make-action-goal-msg *many* :goal 3) :transition-cb (lambda (handle) (push (comm-state handle) *heard*)))) (wait-duration 1.5) (list (comm-state *handle*) (goal-status *handle*) (terminal-state *handle*) (first *heard*)))
;=> \(:DONE :SUCCEEDED :SUCCEEDED :DONE\)

(list (stringp (goal-id *handle*)) (actionlib-msg:result (result *handle*)))
;=> \(T 6\)

(progn (setf *handle* (send-goal *many* (make-action-goal-msg *many* :goal 99))) (wait-duration 0.6) (list (comm-state *handle*) (goal-status *handle*) (terminal-state *handle*)))
;=> \(:ACTIVE :ACTIVE NIL\)

(progn (cancel *handle*) (comm-state *handle*))
;=> :WAITING-FOR-CANCEL-ACK

(progn (wait-duration 1) (list (comm-state *handle*) (goal-status *handle*) (terminal-state *handle*)))
;=> \(:DONE :PREEMPTED :PREEMPTED\)

(handler-case (actionlib-lisp:send-goal-and-wait *client* (make-action-goal-msg *client* :nonsense 7) 5 5) (error (e) (typep e 'error)))
;=> T

(handler-case (send-goal *client* nil) (error (e) (typep e 'error)))
;=> T
