"""Examples of roslisp, actionlib and tf. Node "n" runs in each, and its output goes nowhere."""

from example import Example

NODE = '(start-ros-node "n") '
POSE = '(make-msg "turtlesim/Pose" :x 5.5 :theta 1.5)'
SERVICE = """(def-service-callback (add-two roscpp_tutorials-srv:TwoInts) (a b) (note (list a b)) (make-response :sum (+ a b)))
             (register-service-fn "add" #'add-two 'roscpp_tutorials-srv:TwoInts)"""
SERVICE_IN_PYTHON = """
def add_two(request):
    note([request.a, request.b])
    return {"sum": request.a + request.b}
"""
CALL = """(with-fields (sum) (call-service "add" "roscpp_tutorials/TwoInts" :a 3 :b 4) sum)"""


def logged(level):
    noted = "" if level == "debug" else "note"  # a line that is not printed
    return Example(
        f"""{NODE} (ros-{level} (base drive) "at ~a m/s" (note 5)) (ros-{level} (base) nil "never ~a" (note 6)) 1""",
        f"""
        with ros_node("n"):
            ros_{level}(("base", "drive"), f"at {{{noted}(5)}} m/s")
        1
        """,
    )


ROSLISP = {
    "make-message": Example(
        '(with-fields ((x (x linear)) (z (z angular))) (make-message "geometry_msgs/Twist" (:x :linear) 2 (:z :angular) 3) (list x z))',
        """
        Twist, Vector3 = message_class("geometry_msgs/Twist"), message_class("geometry_msgs/Vector3")
        twist = Twist(linear=Vector3(x=2), angular=Vector3(z=3))
        [twist.linear.x, twist.angular.z]
        """,
    ),
    "make-msg": Example(
        f"(with-fields (x theta) {POSE} (list x theta))",
        """
        pose = message_class("turtlesim/Pose")(x=5.5, theta=1.5)
        [pose.x, pose.theta]
        """,
    ),
    "make-request": Example(
        '(with-fields (a b) (make-request "roscpp_tutorials/TwoInts" :a 3 :b 4) (list a b))',
        """
        request = service_type("roscpp_tutorials/TwoInts").request(a=3, b=4)
        [request.a, request.b]
        """,
    ),
    "make-publisher-msg": Example(
        NODE + '(defvar *pub* (advertise "pose" "turtlesim/Pose")) (with-fields (x) (make-publisher-msg *pub* :x 3.5) x)',
        """
        with ros_node("n"):
            poses = advertise("pose", "turtlesim/Pose")
            x = poses.type(x=3.5).x
        x
        """,
    ),
    "publish-msg": Example(
        NODE
        + """(subscribe "pose" "turtlesim/Pose" (lambda (message) (with-fields (x) message (note x))))
             (defvar *pub* (advertise "pose" "turtlesim/Pose")) (wait-duration 1) (publish-msg *pub* :x 3.5) (wait-duration 1) 1""",
        """
        with ros_node("n"):
            subscribe("pose", "turtlesim/Pose", lambda message: note(message.x))
            poses = advertise("pose", "turtlesim/Pose")
            wait_duration(1)
            publish(poses, poses.type(x=3.5))
            wait_duration(1)
        1
        """,
    ),
    "modify-message-copy": Example(
        f"(defvar *pose* {POSE}) (with-fields (x theta) (modify-message-copy *pose* :x 7.5) (note x) (note theta)) (with-fields (x) *pose* x)",
        """
        pose = message_class("turtlesim/Pose")(x=5.5, theta=1.5)
        other = pose.copy()
        other.x = 7.5
        note(other.x)
        note(other.theta)
        pose.x
        """,
    ),
    "setf-msg": Example(
        f"(defvar *pose* {POSE}) (setf-msg *pose* :x 7.5) (with-fields (x theta) *pose* (list x theta))",
        """
        pose = message_class("turtlesim/Pose")(x=5.5, theta=1.5)
        pose.x = 7.5
        [pose.x, pose.theta]
        """,
    ),
    "with-fields": Example(
        '(with-fields ((y (y linear)) angular) (make-msg "geometry_msgs/Twist" (:y :linear) 2) (with-fields (z) angular (list y z)))',
        """
        Twist, Vector3 = message_class("geometry_msgs/Twist"), message_class("geometry_msgs/Vector3")
        match Twist(linear=Vector3(y=2)):
            case Twist(linear=Vector3(y=y), angular=angular):
                result = [y, angular.z]
        result
        """,
    ),
    "store-message-in": Example(
        NODE
        + """(defvar *last* nil) (subscribe "name" "std_msgs/String" (store-message-in *last*))
             (defvar *pub* (advertise "name" "std_msgs/String")) (wait-duration 1) (publish-msg *pub* :data "walter") (wait-duration 1)
             (with-fields (data) *last* data)""",
        """
        last = None
        def store(message):
            global last
            last = message
        with ros_node("n"):
            subscribe("name", "std_msgs/String", store)
            names_sent = advertise("name", "std_msgs/String")
            wait_duration(1)
            publish(names_sent, names_sent.type(data="walter"))
            wait_duration(1)
        last.data
        """,
    ),
    "ros-debug": logged("debug"),
    "ros-info": logged("info"),
    "ros-warn": logged("warn"),
    "ros-error": logged("error"),
    "ros-fatal": logged("fatal"),
    "set-debug-levels": Example(
        NODE + '(set-debug-levels (base) :error) (ros-info (base) "not ~a" (note 1)) 1',
        """
        with ros_node("n"):
            log_level("base", "error")
            ros_info("base", "not printed")
        1
        """,
    ),
    "with-ros-node": Example(
        '(with-ros-node ("n") (note 1) (note (node-status)) 7)',
        """
        with ros_node("n"):
            note(1)
            note(node_status())
        7
        """,
    ),
    "def-ros-node": Example(
        """(def-ros-node listener (speed) () (note speed) 5) (start-ros-node "n") (set-param "/listener/speed" 2) (shutdown-ros-node)
           (listener)""",
        """
        def listener():
            with ros_node("listener"):
                note(get_param("~speed"))
                return 5
        with ros_node("n"):
            set_param("/listener/speed", 2)
        listener()
        """,
    ),
    "def-service-callback": Example(
        NODE + SERVICE + CALL,
        SERVICE_IN_PYTHON
        + """
with ros_node("n"):
    register_service("add", "roscpp_tutorials/TwoInts", add_two)
    total = call_service("add", "roscpp_tutorials/TwoInts", a=3, b=4).sum
total
""",
    ),
    "register-service": Example(
        NODE
        + """(def-service-callback roscpp_tutorials-srv:TwoInts (a b) (make-response :sum (+ a (note b))))
             (register-service "add" roscpp_tutorials-srv:TwoInts)"""
        + CALL,
        """
        TwoInts = service_type("roscpp_tutorials/TwoInts")
        def add(request):
            return TwoInts.response(sum=request.a + note(request.b))
        with ros_node("n"):
            register_service("add", TwoInts, add)
            total = call_service("add", TwoInts, a=3, b=4).sum
        total
        """,
    ),
    "def-service-call": Example(
        NODE + SERVICE + """(def-service-call (add-up "roscpp_tutorials/TwoInts") "add" :return-field sum) (add-up :a 3 :b 4)""",
        SERVICE_IN_PYTHON
        + """
def add_up(a, b):
    return call_service("add", "roscpp_tutorials/TwoInts", a=a, b=b).sum
with ros_node("n"):
    register_service("add", "roscpp_tutorials/TwoInts", add_two)
    total = add_up(3, b=4)
total
""",
    ),
    "loop-at-most-every": Example(
        NODE + "(defvar *n* 0) (loop-at-most-every 0.5 (setf *n* (note (+ *n* 1))) (when (= *n* 3) (return (* 10 *n*))))",
        """
        def main():
            for n in range(1, 4):
                note(n)
                if n < 3:
                    cpl.sleep(0.5)
            return 10 * n
        run(main)
        """,
    ),
    "spin-until": Example(
        NODE + "(defvar *n* 0) (spin-until (= *n* 3) 0.5 (setf *n* (note (+ *n* 1))))",
        """
        def main():
            n = 0
            while n < 3:
                n = note(n + 1)
                cpl.sleep(0.5)
            return n == 3
        run(main)
        """,
    ),
    "with-parallel-thread": Example(
        NODE + '(with-parallel-thread ((lambda () (note "beside")) "helper") (wait-duration 1) (note "body") 3)',
        """
        def beside():
            note("beside")
            cpl.sleep(9)
        def main():
            with cpl.par() as branches:
                helper = branches.start(beside)
                cpl.sleep(1)
                note("body")
                helper.evaporate()
            return 3
        run(main)
        """,
    ),
    "load-message-types": Example(
        '(load-message-types "turtlesim/Pose") 1',
        """
        Pose = message_class("turtlesim/Pose")
        1
        """,
    ),
    "load-service-types": Example(
        '(load-service-types "std_srvs/Empty") 1',
        """
        Empty = service_type("std_srvs/Empty")
        1
        """,
    ),
    "load-msg": Example(
        '(load-msg "trajectory_msgs/JointTrajectory") 1',
        """
        JointTrajectory = message_class("trajectory_msgs/JointTrajectory")
        1
        """,
    ),
    "load-srv": Example(
        '(load-srv "tf2_msgs/FrameGraph") 1',
        """
        FrameGraph = service_type("tf2_msgs/FrameGraph")
        1
        """,
    ),
    "load-if-necessary": Example('(handler-case (load-if-necessary 1) (error () "deprecated"))', only="deprecated: in Lisp it is an error"),
    "register-ros-init-function": Example(
        """(defun hello () (note "hello")) (roslisp-utilities:register-ros-init-function hello 3) (roslisp-utilities:startup-ros) 1""",
        """
        def hello():
            note("hello")
        with ros_node("n"):
            hello()
        1
        """,
    ),
    "register-ros-cleanup-function": Example(
        """(defun bye () (note "bye")) (roslisp-utilities:register-ros-cleanup-function bye)
           (roslisp-utilities:startup-ros) (roslisp-utilities:shutdown-ros) 1""",
        """
        def bye():
            note("bye")
        with ros_node("n"):
            try:
                pass
            finally:
                bye()
        1
        """,
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
COUNT_IN_PYTHON = """
from cramhy_runtime.actionlib.python import *
with ros_node("n"):
    @action_server("count", "actionlib_tutorials/FibonacciAction")
    def count_up(goal):
        note(goal.order)
        publish_feedback(sequence=[goal.order])
        if goal.order > 5:
            abort_current()
        if goal.order > 3:
            preempt_current()
        succeed_current(sequence=[goal.order, goal.order])
    client = action_client("count", "actionlib_tutorials/FibonacciAction")
"""
GOAL_IN_PYTHON = (
    COUNT_IN_PYTHON
    + """
    goal = make_goal(client, order=7)
goal.order
"""
)
STATE_IN_PYTHON = (
    COUNT_IN_PYTHON
    + """
    result, state = call_goal(client, order={})
state
"""
)

ACTIONLIB = {
    "make-action-goal-msg": Example(
        """(start-ros-node "n") (actionlib:def-exec-callback count-up (order) (actionlib:succeed-current))
           (actionlib:start-action-server "count" "actionlib_tutorials/FibonacciAction" #'count-up :separate-thread t)
           (defvar *client* (actionlib-lisp:make-simple-action-client "count" "actionlib_tutorials/FibonacciAction"))
           (with-fields (order) (actionlib-lisp:make-action-goal-msg *client* :order 7) order)""",
        GOAL_IN_PYTHON,
    ),
    "make-action-goal": Example(SERVER + "(with-fields (order) (actionlib:make-action-goal *client* :order 7) order)", GOAL_IN_PYTHON),
    "def-exec-callback": Example(SERVER + STATE.format(2), STATE_IN_PYTHON.format(2)),
    "succeed-current": Example(SERVER + STATE.format(1), STATE_IN_PYTHON.format(1)),
    "abort-current": Example(SERVER + STATE.format(6), STATE_IN_PYTHON.format(6)),
    "preempt-current": Example(SERVER + STATE.format(4), STATE_IN_PYTHON.format(4)),
    "publish-feedback": Example(
        SERVER
        + """(multiple-value-bind (result state)
               (actionlib:call-goal *client* (actionlib:make-action-goal *client* :order 2) :feedback-cb (lambda (feedback) (note "feedback"))) state)""",
        COUNT_IN_PYTHON
        + """
    result, state = call_goal(client, order=2, on_feedback=lambda feedback: note("feedback"))
state
""",
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
        """
        from cramhy_runtime.tf.broadcasting import broadcasting, make_transform_broadcaster
        from cramhy_runtime.tf.stamped import TransformStamped
        from cramhy_runtime.transforms.vectors import Vector3
        messages = []
        with ros_node("n"):
            subscribe("/tf", "tf/tfMessage", messages.append)
            sender = make_transform_broadcaster()
            with broadcasting(sender, TransformStamped("map", "cup", 0.0, Vector3(1, 2, 3))):
                wait_duration(1.05)
                note("body")
        len(messages) > 5
        """,
    )
}
