"""ROS from Python, without a line of Lisp: `cramhy_runtime.ros.python`, `cramhy_runtime.actionlib.python`, and `broadcasting` of tf."""

import pytest
from systems import ONE_BACKEND

from cramhy_runtime import cpl, kernel
from cramhy_runtime.actionlib.python import (
    abort_current,
    action_client,
    action_server,
    call_goal,
    cancel_requested,
    make_goal,
    preempt_current,
    publish_feedback,
    succeed_current,
)
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.prolog import kw
from cramhy_runtime.ros.python import (
    advertise,
    call_service,
    get_param,
    log_level,
    message_class,
    node_status,
    publish,
    register_service,
    ros_info,
    ros_node,
    set_param,
    subscribe,
    wait_duration,
)
from cramhy_runtime.session import Image
from cramhy_runtime.tf.broadcasting import broadcasting, make_transform_broadcaster
from cramhy_runtime.tf.stamped import TransformStamped

TWO_INTS = "roscpp_tutorials/TwoInts"
FIBONACCI = "actionlib_tutorials/FibonacciAction"


@pytest.fixture(params=ONE_BACKEND, autouse=True)
def node(request, session):
    with Image(as_now=True):
        kernel.start(clock="virtual", backend=request.param, time_limit=3600)
        try:
            with ros_node("tester"):
                yield
        finally:
            kernel.stop()


def test_a_message_reaches_who_has_subscribed():
    seen = []
    subscribe("pose", "turtlesim/Pose", seen.append)
    publish(advertise("pose", "turtlesim/Pose"), message_class("turtlesim/Pose")(x=3.5))
    wait_duration(1)
    assert [pose.x for pose in seen] == [3.5]


def test_a_service_takes_and_gives_fields():
    register_service("add", TWO_INTS, lambda request: {"sum": request.a + request.b})
    assert call_service("add", TWO_INTS, a=3, b=4).sum == 7
    with pytest.raises(TypeError, match="c"):
        call_service("add", TWO_INTS, c=3)
    with pytest.raises(TypeError, match="needs the type of the service"):
        call_service("add")


def test_what_the_callback_of_a_service_raises_reaches_the_log_and_the_caller(printed):
    def refuse(request):
        raise ValueError("no numbers today")

    register_service("add", TWO_INTS, refuse)
    with pytest.raises(SimpleError, match="no numbers today"):
        call_service("add", TWO_INTS, a=3, b=4)
    assert "no numbers today" in printed()


def test_a_line_of_the_log_has_its_topic_and_a_level_keeps_it_back(printed):
    ros_info(("base", "drive"), "at 5 m/s, 100 % sure~")
    log_level("base", "error")
    ros_info(("base", "drive"), "not this one")
    log_level(("base", "drive"), "info")
    ros_info(("base", "drive"), "but this")
    assert [line.partition("] ")[::2] for line in printed().splitlines() if "BASE" in line] == [
        ("[(BASE DRIVE) INFO", "1292688670.768: at 5 m/s, 100 % sure~"),
        ("[(BASE DRIVE) INFO", "1292688670.768: but this"),
    ]


def test_private_parameters_come_with_the_node_and_the_node_goes_with_the_block():
    with ros_node("driver", arguments=["_speed:=2"]):
        assert get_param("~speed") == 2
        set_param("~name", "anna")
    assert node_status() is kw.shutdown


def test_the_node_goes_when_the_block_fails():
    with pytest.raises(ValueError), ros_node("driver"):
        raise ValueError
    assert node_status() is kw.shutdown


def test_goals_end_as_the_server_says():
    @action_server("count", FIBONACCI)
    def count(goal):
        publish_feedback(sequence=[goal.order])
        if goal.order > 5:
            abort_current()
        if goal.order > 3:
            preempt_current()
        succeed_current(sequence=[goal.order, goal.order])

    client, told = action_client("count", FIBONACCI, timeout=5), []
    result, state = call_goal(client, order=2, on_feedback=lambda feedback: told.append(list(feedback.sequence)))
    assert (list(result.sequence), state, told) == ([2, 2], kw.succeeded, [[2]])
    assert call_goal(client, make_goal(client, order=6))[1] is kw.aborted
    assert call_goal(client, order=4)[1] is kw.preempted


@pytest.mark.parametrize(("work", "told"), [(lambda goal: int("x"), "invalid literal for int"), (lambda goal: None, "without succeeding")])
def test_a_function_that_raises_or_only_returns_aborts_its_goal_and_the_log_says_why(work, told, printed):
    action_server("count", FIBONACCI)(work)
    assert call_goal(action_client("count", FIBONACCI), order=2)[1] is kw.aborted
    assert told in printed()


def test_a_plan_that_loses_a_race_cancels_its_goal():
    ended = []

    @action_server("count", FIBONACCI)
    def count(goal):
        while not cancel_requested():
            cpl.sleep(0.25)
        ended.append(cpl.now())
        preempt_current()

    client = action_client("count", FIBONACCI)
    begin = cpl.now()
    cpl.run(lambda: cpl.pursue(lambda: call_goal(client, order=9), lambda: cpl.sleep(2)))
    wait_duration(1)
    assert 2 <= ended[0] - begin <= 2.5


def test_a_goal_and_fields_of_one_do_not_go_together_and_a_missing_server_is_told():
    with pytest.raises(TimeoutError, match="count.*within 2 s"):
        action_client("count", FIBONACCI, timeout=2)
    action_server("count", FIBONACCI)(lambda goal: succeed_current())
    client = action_client("count", FIBONACCI)
    with pytest.raises(TypeError, match="Give one of them"):
        call_goal(client, make_goal(client, order=1), order=2)


def test_transforms_are_sent_while_the_block_runs_however_it_ends():
    seen = []
    subscribe("/tf", "tf/tfMessage", seen.append)
    sender = make_transform_broadcaster()
    with pytest.raises(ValueError), broadcasting(sender, TransformStamped("map", "cup", 0.0)):
        wait_duration(1.05)
        raise ValueError
    count = len(seen)
    wait_duration(1)
    assert count >= 10 and len(seen) - count <= 1
