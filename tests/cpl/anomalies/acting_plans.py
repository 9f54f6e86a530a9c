"""Plans that act: requests to process modules of both kinds, performed designators, modules that are run by hand.

Each request carries a log of its own, a function in the designator, which the body calls when it begins and when it is done. What a plan
gives is ``:right`` only if every result was that of its own request, no request was done twice, and the modules are offline in the
end; ``:twice`` says that one was done again, as it is after a suspension.
"""

from __future__ import annotations

from .plans import Plan

HELPERS = """
(defun request (log goal &rest more)
  (desig:make-designator :motion `((:type :acting) (:goal ,goal) (:log ,log) ,@more)))
(defun goal-of (motion) (desig:desig-prop-value motion :goal))
(defun tell (motion event) (funcall (desig:desig-prop-value motion :log) (list event (goal-of motion))))
(defun judge (events results modules)
  (cond ((notevery (lambda (pair) (equal (first pair) (second pair))) results) (list :wrong results))
        ((notevery (lambda (module) (cl:eq (value (status module)) :offline)) modules) :not-offline)
        ((some (lambda (event) (> (count event events :test #'equal) 1)) events) :twice)
        (t :right)))
(cpm:def-process-module acting-drive (motion)
  (tell motion :begun)
  (guarded-slowly driving 0.1 (par (sleep 0.2) (guarded wheel (sleep 0.1))))
  (tell motion :done)
  (values (goal-of motion) :driven))
(cpm:def-process-module acting-arm (motion)
  (guarded-slowly reaching 0.1
    (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return)))
      (pursue (sleep 10) (progn (sleep 0.1) (fail "slipped"))))
    (cpm:pm-execute 'acting-drive (request (desig:desig-prop-value motion :log) (list :for (goal-of motion)))))
  (goal-of motion))
(cpm:def-asynchronous-process-module acting-belt ((work :initform (make-fluent :name 'work :value nil) :reader work)))
(defmethod cpm:synchronization-fluent ((belt acting-belt) input) (declare (ignore input)) (not (work belt)))
(defmethod cpm:on-input ((belt acting-belt) input)
  (guarded-slowly taking 0.1 (sleep 0.1) (tell input :begun) (setf (value (work belt)) input)))
(defmethod cpm:on-run ((belt acting-belt))
  (guarded-slowly running 0.1
    (whenever ((work belt))
      (guarded working (sleep 0.1))
      (let ((input (value (work belt))))
        (setf (value (work belt)) nil)
        (tell input :done)
        (if (cl:eql (goal-of input) :jam)
            (cpm:fail-process-module belt (make-condition 'simple-plan-failure :format-control "jammed") :designator input)
            (cpm:finish-process-module belt :designator input))))))
(defmacro acting ((&rest modules) &body body)
  "The judgement of BODY, in which (ask module goal) notes the result of a request; (log) logs the events of others."
  `(let ((events nil) (results nil) (running nil))
     (flet ((note (event) (push event events)))
       (labels ((ask (module goal) (push (list goal (cpm:pm-execute module (request #'note goal))) results)))
         (declare (ignorable #'ask))
         (guarded around
           (cpm:with-process-modules-running ,modules
             (setf running (mapcar #'cpm:get-running-process-module
                                   ',(mapcar (lambda (module) (if (listp module) (first module) module)) modules)))
             (top-level (guarded outer ,@body))))
         (judge events results running)))))
t
"""

ENDED = ("UnknownProcessModule*", "ProcessModuleNotRunning*", "SimplePlanFailure: The execution of*", "no values")
"""What a plan may end with when a task of a module, or of its own, was ended."""

ACTING_PLANS = [
    Plan(
        "queue-of-requests",
        """
        (acting (acting-drive (acting-other acting-drive))
          (handler-bind ((warning #'muffle-warning))
            (par (guarded one (ask 'acting-drive 1) (ask 'acting-other 2))
                 (guarded two (handler-bind ((warning #'muffle-warning)) (ask 'acting-drive 3)))
                 (guarded-slowly three 0.1 (pursue (handler-bind ((warning #'muffle-warning)) (ask 'acting-drive 4)) (sleep 0.4))))))
        """,
        ":RIGHT",
        evaporated=ENDED,
        suspended=(":TWICE",),
    ),
    Plan(
        "a-module-that-calls-another",
        """
        (acting (acting-drive acting-arm)
          (par (guarded reach (ask 'acting-arm 1))
               (guarded drive (sleep 0.2) (handler-bind ((warning #'muffle-warning)) (ask 'acting-drive 2)))))
        """,
        ":RIGHT",
        evaporated=(*ENDED, "*wrong*"),
        suspended=(":TWICE",),
    ),
    Plan(
        "modules-run-by-hand",
        """
        (let ((events nil) (results nil))
          (flet ((ask (name goal)
                   (push (list goal (cpm:pm-execute name (request (lambda (event) (push event events)) goal))) results)))
            (top-level
              (guarded outer
                (with-tags
                  (pursue
                    (:tag module (guarded running (cpm:pm-run 'acting-drive 'acting-by-hand)))
                    (guarded plan
                      (cpm:wait-for-process-module-running 'acting-by-hand)
                      (cpm:with-process-module-aliases ((acting-base acting-by-hand))
                        (pursue (ask 'acting-base 1) (sleep 3))
                        (ask 'acting-by-hand 2)))
                    (guarded meddling (sleep 0.15) (with-task-suspended (module) (sleep 0.2)) (sleep 9))))))
            (if (cpm:get-running-process-module 'acting-by-hand) :still-running (judge events results nil))))
        """,
        ":RIGHT",
        evaporated=ENDED,
        suspended=(":TWICE",),
    ),
    Plan(
        "asynchronous-module",
        """
        (acting (acting-belt)
          (let ((one (request #'note 1)) (two (request #'note 2)) (jam (request #'note :jam)))
            (flet ((watch (&rest designators)
                     (handler-case (cpm:monitor-process-module 'acting-belt :designators designators)
                       (simple-plan-failure (e) (push (list (format nil "~a" e) "jammed") results)))))
              (par (guarded sender (cpm:pm-execute 'acting-belt one) (cpm:pm-execute 'acting-belt two))
                   (guarded-slowly other 0.1 (cpm:pm-execute 'acting-belt jam))
                   (guarded first (sleep 0.1) (pursue (watch one) (sleep 5)))
                   (guarded-slowly second 0.1 (sleep 0.5) (pursue (watch two jam) (sleep 5)))))))
        """,
        ":RIGHT",
        evaporated=(*ENDED, "SimpleError: Cannot*", "(:WRONG*was cancelled*", "(:WRONG*"),
        suspended=(":TWICE",),
        failed=("SimpleError: Cannot*", "(:WRONG*", "*not running*", "UnknownProcessModule*"),
    ),
    Plan(
        "performing-actions",
        """
        (prolog:def-fact-group acting-facts
            (cpm:matching-process-module cpm:available-process-module desig:motion-grounding desig:action-grounding)
          (prolog:<- (cpm:matching-process-module ?d acting-clumsy) (desig:desig-prop ?d (:type :acting)))
          (prolog:<- (cpm:matching-process-module ?d acting-drive) (desig:desig-prop ?d (:type :acting)))
          (prolog:<- (cpm:available-process-module acting-clumsy))
          (prolog:<- (cpm:available-process-module acting-drive))
          (prolog:<- (desig:motion-grounding ?d (drive ?goal)) (desig:desig-prop ?d (:goal ?goal)))
          (prolog:<- (desig:action-grounding ?d (acting-tour ?log ?goals))
            (desig:desig-prop ?d (:type :touring)) (desig:desig-prop ?d (:log ?log)) (desig:desig-prop ?d (:goals ?goals))))
        (cpm:def-process-module acting-clumsy (motion)
          (declare (ignore motion))
          (guarded-slowly clumsy 0.1 (sleep 0.1) (fail "clumsy")))
        (def-cram-function acting-tour (log goals)
          (guarded touring
            (mapcar (lambda (goal) (list goal (exe:perform (request log goal)))) goals)))
        (let ((events nil) (results nil))
          (cpm:with-process-modules-running (acting-clumsy acting-drive)
            (top-level
              (guarded outer
                (with-failure-handling ((simple-plan-failure (e) (declare (ignore e)) (return)))
                  (par (setf results (exe:perform (desig:make-designator :action `((:type :touring) (:goals (1 2))
                                                                                  (:log ,(lambda (event) (push event events)))))))
                       (guarded-slowly beside 0.1 (sleep 0.3)))))))
          (judge events results nil))
        """,
        ":RIGHT",
        evaporated=(*ENDED, "(:WRONG ((* NIL)*", "(:WRONG *NIL)))"),
        suspended=(":TWICE",),
    ),
]
