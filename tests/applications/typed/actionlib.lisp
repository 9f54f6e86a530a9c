(progn (asdf:load-system :actionlib) (asdf:load-system :actionlib-msg))
;=> T

(progn (defpackage :asking (:use :cl :roslisp :actionlib)) (in-package :asking))
;=> #<PACKAGE "ASKING">

(start-ros-node "asking")
;=> 0

(defvar *heard* nil)
;=> \*HEARD\*

(list *action-server-timeout* *status-publish-interval* *gc-interval*)
;=> \(2\.0 0\.25 10\.0\)

(def-exec-callback nursing (goal) "Doubles." (publish-feedback :feedback (1+ goal)) (wait-duration 0.3) (cond ((< goal 0) (abort-current :result goal)) ((= goal 99) (loop until (cancel-request-received) do (wait-duration 0.1)) (preempt-current :result 1)) (t (succeed-current (make-msg "actionlib/TestResult" :result (* 2 goal))))))
;=> NURSING

(documentation 'nursing 'function)
;=> "Doubles\."

(progn (start-action-server "nurse" "actionlib/TestAction" #'nursing :separate-thread t) (wait-duration 0.5) 'started)
;=> STARTED

(defvar *client* (make-action-client "nurse" "actionlib/TestAction"))
;=> \*CLIENT\*

(list (type-of *client*) (wait-for-server *client* 5) (connected-to-server *client*))
;=> \(ACTIONLIB::ACTION-CLIENT T T\)

(type-of (make-action-goal *client* :goal 7))
;=> ACTIONLIB-MSG:TESTGOAL

(multiple-value-list (wait-for-server (make-action-client "nobody" "actionlib/TestAction") 0.5))
;=> \(NIL\)

(handler-case (send-goal (make-action-client "nobody" "actionlib/TestAction") (make-action-goal *client* :goal 1)) (error (e) (list (typep e 'simple-error) (princ-to-string e))))
;=> \(T "Not connected to an action server\. Cannot send goal\."\)

(multiple-value-bind (result state) (call-goal *client* (make-action-goal *client* :goal 7)) (list (actionlib-msg:result result) state))
;=> \(14 :SUCCEEDED\)

(multiple-value-bind (result state) (call-goal *client* (make-action-goal *client* :goal -3) :timeout 5) (list (actionlib-msg:result result) state))
;=> \(-3 :ABORTED\)

(multiple-value-list (call-goal *client* (make-action-goal *client* :goal 99) :timeout 1))
;=> \(NIL :TIMEOUT\)

(progn (wait-duration 1) (multiple-value-bind (result state) (send-goal-and-wait *client* (make-action-goal *client* :goal 8) :exec-timeout 5 :result-timeout 2) (list (actionlib-msg:result result) state)))
;=> \(16 :SUCCEEDED\)

(progn (setf *heard* nil) (multiple-value-bind (result state) (call-goal *client* (make-action-goal *client* :goal 4) :feedback-cb (lambda (message) (push (actionlib-msg:feedback message) *heard*))) (list (actionlib-msg:result result) state *heard*)))
;=> \(8 :SUCCEEDED \(5\)\)

(handler-bind ((feedback-signal (lambda (signal) (setf *heard* (list (actionlib-msg:feedback (feedback signal)) (stringp (goal-id (goal signal))))) (invoke-restart 'abort-goal :enough)))) (append (multiple-value-list (call-goal *client* (make-action-goal *client* :goal 99))) *heard*))
;=> \(:ENOUGH :ABORTED 100 T\)

(progn (wait-duration 1) (setf *heard* nil) (defvar *goal* (send-goal *client* (make-action-goal *client* :goal 5) (lambda (state result) (push (list :done state (actionlib-msg:result result)) *heard*)) (lambda (message) (push (list :feedback (actionlib-msg:feedback message)) *heard*)) (lambda () (push :active *heard*)) (lambda (state) (push state *heard*)))) (type-of *goal*))
;=> ACTIONLIB::CLIENT-GOAL-HANDLE

(multiple-value-bind (result state) (wait-for-result *goal* 5) (wait-duration 0.5) (list (actionlib-msg:result result) state (simple-state *goal*)))
;=> \(10 :SUCCEEDED :DONE\)

(list (count :active *heard*) (find :feedback (remove-if #'atom *heard*) :key #'first) (find :done (remove-if #'atom *heard*) :key #'first) (not (null (member :done *heard*))))
;=> \(2 \(:FEEDBACK 6\) \(:DONE :SUCCEEDED 10\) T\)

(actionlib-msg:result (result *goal*))
;=> 10

(progn (setf *goal* (send-goal *client* (make-action-goal *client* :goal 99))) (wait-duration 1) (list (simple-state *goal*) (result *goal*) (multiple-value-list (wait-for-result *goal* 0.5))))
;=> \(:ACTIVE NIL \(NIL :TIMEOUT\)\)

(progn (cancel-goal *goal*) (multiple-value-bind (result state) (wait-for-result *goal* 5) (list (actionlib-msg:result result) state (simple-state *goal*))))
;=> \(1 :PREEMPTED :DONE\)

(multiple-value-bind (result state) (wait-for-result *goal*) (list (actionlib-msg:result result) state))
;=> \(1 :PREEMPTED\)

(let ((first (send-goal *client* (make-action-goal *client* :goal 99)))) (wait-duration 0.8) (let ((second (send-goal *client* (make-action-goal *client* :goal 6)))) (list (nth-value 1 (wait-for-result first 5)) (nth-value 1 (wait-for-result second 5)) (actionlib-msg:result (result second)))))
;=> \(:PREEMPTED :SUCCEEDED 12\)

(handler-case (make-action-client "nurse" "nowhere/TestAction") (error (e) (princ-to-string e)))
;=> "Package for action `nowhere/TestAction' doesn't seem to be loaded"

(handler-case (make-action-client 'nurse "actionlib/TestAction") (error (e) (typep e 'type-error)))
;=> T

(handler-case (make-action-client "nurse" "actionlib/Test") (error (e) (princ-to-string e)))
;=> "The action type is invalid\. Actions always have the suffix 'Action'"

(handler-case (cancel-request-received) (error (e) (princ-to-string e)))
;=> "This operation can only be called while in a callback thread"

(handler-case (succeed-current :result 1) (error (e) (typep e 'error)))
;=> T

(handler-case (nursing (make-msg "actionlib/TestGoal" :goal 3)) (error (e) (typep e 'error)))
;=> T

(macrolet ((names (package) `(loop for name being the external-symbols of ,package collect name))) (length (names :actionlib)))
;=> 28

(handler-case (send-goal-and-wait *client* (make-action-goal *client* :goals 8)) (error (e) (typep e 'error)))
;=> T
