"""Examples of roslisp, actionlib and tf. Node "n" runs in each, and its output goes nowhere."""

from example import Example

NODE = '(start-ros-node "n") '
DIRECT = "messages are Python objects with attributes; see docs/ros-bridge.md"
POSE = '(make-msg "turtlesim/Pose" :x 5.5 :theta 1.5)'
LOGGED = "Python's own `logging`"
SERVICE = """(def-service-callback (add-two roscpp_tutorials-srv:TwoInts) (a b) (note (list a b)) (make-response :sum (+ a b)))
             (register-service-fn "add" #'add-two 'roscpp_tutorials-srv:TwoInts)"""
CALL = """(with-fields (sum) (call-service "add" "roscpp_tutorials/TwoInts" :a 3 :b 4) sum)"""


def logged(level):
    return Example(
        f"""{NODE} (ros-{level} (base drive) "at ~a m/s" (note 5)) (ros-{level} (base) nil "never ~a" (note 6)) 1""", only=LOGGED
    )


ROSLISP = {
    "make-message": Example(
        '(with-fields ((x (x linear)) (z (z angular))) (make-message "geometry_msgs/Twist" (:x :linear) 2 (:z :angular) 3) (list x z))',
        only=DIRECT,
    ),
    "make-msg": Example(f"(with-fields (x theta) {POSE} (list x theta))", only=DIRECT),
    "make-request": Example('(with-fields (a b) (make-request "roscpp_tutorials/TwoInts" :a 3 :b 4) (list a b))', only=DIRECT),
    "make-publisher-msg": Example(
        NODE + '(defvar *pub* (advertise "pose" "turtlesim/Pose")) (with-fields (x) (make-publisher-msg *pub* :x 3.5) x)', only=DIRECT
    ),
    "publish-msg": Example(
        NODE
        + """(subscribe "pose" "turtlesim/Pose" (lambda (message) (with-fields (x) message (note x))))
             (defvar *pub* (advertise "pose" "turtlesim/Pose")) (wait-duration 1) (publish-msg *pub* :x 3.5) (wait-duration 1) 1""",
        only=DIRECT,
    ),
    "modify-message-copy": Example(
        f"(defvar *pose* {POSE}) (with-fields (x theta) (modify-message-copy *pose* :x 7.5) (note x) (note theta)) (with-fields (x) *pose* x)",
        only="`copy.copy`",
    ),
    "setf-msg": Example(f"(defvar *pose* {POSE}) (setf-msg *pose* :x 7.5) (with-fields (x theta) *pose* (list x theta))", only=DIRECT),
    "with-fields": Example(
        '(with-fields ((y (y linear)) angular) (make-msg "geometry_msgs/Twist" (:y :linear) 2) (with-fields (z) angular (list y z)))',
        only=DIRECT,
    ),
    "store-message-in": Example(
        NODE
        + """(defvar *last* nil) (subscribe "name" "std_msgs/String" (store-message-in *last*))
             (defvar *pub* (advertise "name" "std_msgs/String")) (wait-duration 1) (publish-msg *pub* :data "walter") (wait-duration 1)
             (with-fields (data) *last* data)""",
        only="an assignment in a function",
    ),
    "ros-debug": logged("debug"),
    "ros-info": logged("info"),
    "ros-warn": logged("warn"),
    "ros-error": logged("error"),
    "ros-fatal": logged("fatal"),
    "set-debug-levels": Example(NODE + '(set-debug-levels (base) :error) (ros-info (base) "not ~a" (note 1)) 1', only=LOGGED),
    "with-ros-node": Example('(with-ros-node ("n") (note 1) (note (node-status)) 7)', only="a session has a node"),
    "def-ros-node": Example(
        """(def-ros-node listener (speed) () (note speed) 5) (start-ros-node "n") (set-param "/listener/speed" 2) (shutdown-ros-node)
           (listener)""",
        only="a session has a node",
    ),
    "def-service-callback": Example(NODE + SERVICE + CALL, only=DIRECT),
    "register-service": Example(
        NODE
        + """(def-service-callback roscpp_tutorials-srv:TwoInts (a b) (make-response :sum (+ a (note b))))
             (register-service "add" roscpp_tutorials-srv:TwoInts)"""
        + CALL,
        only=DIRECT,
    ),
    "def-service-call": Example(
        NODE + SERVICE + """(def-service-call (add-up "roscpp_tutorials/TwoInts") "add" :return-field sum) (add-up :a 3 :b 4)""",
        only=DIRECT,
    ),
    "loop-at-most-every": Example(
        NODE + "(defvar *n* 0) (loop-at-most-every 0.5 (setf *n* (note (+ *n* 1))) (when (= *n* 3) (return (* 10 *n*))))",
        only="`cpl.sleep` in a loop",
    ),
    "spin-until": Example(NODE + "(defvar *n* 0) (spin-until (= *n* 3) 0.5 (setf *n* (note (+ *n* 1))))", only="`cpl.wait_for` a fluent"),
    "with-parallel-thread": Example(
        NODE + '(with-parallel-thread ((lambda () (note "beside")) "helper") (wait-duration 1) (note "body") 3)', only="`cpl.par`"
    ),
    "load-message-types": Example('(load-message-types "turtlesim/Pose") 1', only="types are found by their names"),
    "load-service-types": Example('(load-service-types "std_srvs/Empty") 1', only="types are found by their names"),
    "load-msg": Example('(load-msg "trajectory_msgs/JointTrajectory") 1', only="types are found by their names"),
    "load-srv": Example('(load-srv "tf2_msgs/FrameGraph") 1', only="types are found by their names"),
    "load-if-necessary": Example('(handler-case (load-if-necessary 1) (error () "deprecated"))', only="deprecated"),
    "register-ros-init-function": Example(
        """(defun hello () (note "hello")) (roslisp-utilities:register-ros-init-function hello 3) (roslisp-utilities:startup-ros) 1""",
        only="a function that is called",
    ),
    "register-ros-cleanup-function": Example(
        """(defun bye () (note "bye")) (roslisp-utilities:register-ros-cleanup-function bye)
           (roslisp-utilities:startup-ros) (roslisp-utilities:shutdown-ros) 1""",
        only="`with` and `finally`",
    ),
}

TYPE = '"actionlib_tutorials/FibonacciAction"'
SERVER = f"""
(start-ros-node "n")
(actionlib:def-exec-callback count-up (order)
  (note order)
  (actionlib:publish-feedback :sequence (vector order))
  (if (> order 5) (actionlib:abort-current))
  (if (> order 3) (actionlib:preempt-current))
  (actionlib:succeed-current :sequence (vector order order)))
(actionlib:start-action-server "count" {TYPE} #'count-up :separate-thread t)
(defvar *client* (actionlib:make-action-client "count" {TYPE}))
(actionlib:wait-for-server *client*)
"""
STATE = "(multiple-value-bind (result state) (actionlib:call-goal *client* (actionlib:make-action-goal *client* :order {})) state)"
ACTION = "`cramhy_runtime.actionlib` has the functions below; see docs/actions.md"

ACTIONLIB = {
    "make-action-goal-msg": Example(
        """(start-ros-node "n") (actionlib:def-exec-callback count-up (order) (actionlib:succeed-current))
           (actionlib:start-action-server "count" "actionlib_tutorials/FibonacciAction" #'count-up :separate-thread t)
           (defvar *client* (actionlib-lisp:make-simple-action-client "count" "actionlib_tutorials/FibonacciAction"))
           (with-fields (order) (actionlib-lisp:make-action-goal-msg *client* :order 7) order)""",
        only=ACTION,
    ),
    "make-action-goal": Example(SERVER + "(with-fields (order) (actionlib:make-action-goal *client* :order 7) order)", only=ACTION),
    "def-exec-callback": Example(SERVER + STATE.format(2), only=ACTION),
    "succeed-current": Example(SERVER + STATE.format(1), only=ACTION),
    "abort-current": Example(SERVER + STATE.format(6), only=ACTION),
    "preempt-current": Example(SERVER + STATE.format(4), only=ACTION),
    "publish-feedback": Example(
        SERVER
        + """(multiple-value-bind (result state)
               (actionlib:call-goal *client* (actionlib:make-action-goal *client* :order 2) :feedback-cb (lambda (feedback) (note "feedback"))) state)""",
        only=ACTION,
    ),
}

FRAMES = {
    "with-tf-broadcasting": Example(
        """(start-ros-node "n")
           (defvar *count* 0) (subscribe "/tf" "tf/tfMessage" (lambda (message) (setf *count* (+ *count* 1))))
           (defvar *sender* (cl-tf:make-transform-broadcaster))
           (cl-tf:with-tf-broadcasting (*sender* (cl-tf:make-transform-stamped "map" "cup" 0.0 (cl-tf:make-3d-vector 1 2 3)
                                                   (cl-tf:make-identity-rotation)))
             (wait-duration 1.05) (note "body"))
           (> *count* 5)""",
        only="a task that sends; see docs/transforms.md",
    )
}
