"""What every server of an action does: it hears of goals and of requests to end them, and tells the clients how its goals are.

A `GoalServer` belongs to a node and knows nothing of how the work is done. While a goal is worked on, a newer one waits for its turn, takes
the place of one that waits already, and the one that is worked on is asked to end, as in ROS's simple action server. The classes above it
say what happens then: `server.ActionServer` runs a function in a task, `shape_server.ShapeServer` steers from the poses of a turtle.

The server tells the states of its goals four times a second and whenever one changes, and forgets a goal ten seconds after its end. It
lives as long as its node. Source: roslisp.md 13.2, wiki.ros.org/actionlib/DetailedDescription.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

from .. import kernel
from ..ros.messages import message_class, topic_class
from ..ros.roslisp.clock import ros_time
from ..ros.wire import ros_text
from . import goals
from .goals import ACTIVE, PENDING, PREEMPTING, RECALLED, Action

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..ros.graph import Node
    from ..ros.messages import RosMessage
    from ..ros.signatures import MessageType
    from ..ros.topics import Publication

PERIOD = 0.25
"""Seconds between two reports of all states."""
MEMORY = 10.0
"""Seconds for which a finished goal is still reported."""
CANCELLED_EARLY = "It was cancelled before it began."


class ServerGoal:
    """A goal that a client sent: its id message, what is asked, its state, and when it ended."""

    def __init__(self, goal_id: RosMessage, message: RosMessage):
        self.id, self.message = goal_id, message
        self.state, self.ended, self.text = PENDING, None, ""
        self.cancelled = False


class GoalServer:
    """Serves the action ``name`` of the type ``action_type`` (``"turtle_actionlib/ShapeAction"``) at ``node``.

    ``current``: the goal that is worked on, ``next``: the one that waits, or ``None``. ``goals``: all that clients are told of.
    """

    def __init__(self, node: Node, name: str, action_type: str):
        self.node, self.name, self.action = node, goals.check_name(name), Action(action_type)
        self.goals: list[ServerGoal] = []
        self.next: ServerGoal | None = None
        self.current: ServerGoal | None = None
        self.cancelled_ids: dict[str, float] = {}
        self.cancelled_until = 0.0
        self.statuses = self.advertise(f"{name}/status", topic_class(goals.STATUS_ARRAY))
        self.feedbacks = self.advertise(f"{name}/feedback", self.action.action_feedback)
        self.results = self.advertise(f"{name}/result", self.action.action_result)
        self.subscribe(f"{name}/goal", self.action.action_goal, self._goal)
        self.subscribe(f"{name}/cancel", topic_class(goals.GOAL_ID), self._cancel)
        self.timer = node.graph.kernel.call_every(goals.setting("*STATUS-PUBLISH-INTERVAL*", PERIOD), self.report)
        node.on_shutdown.append(self.stopped)
        self.report()

    # --------------------------------------------------------------------------------------------- what the classes above say

    def advertise(self, topic: str, message_type: MessageType) -> Publication:
        """The publication of one of the server's topics."""
        return self.node.advertise(topic, message_type)

    def subscribe(self, topic: str, message_type: MessageType, callback: Callable[[RosMessage], object]) -> None:
        """Let ``callback`` get the messages on one of the server's topics."""
        self.node.subscribe(topic, message_type, callback)

    def begin_wanted(self) -> None:
        """There is a goal that waits, ``next``. `accept` takes it."""

    def end_wanted(self, goal: ServerGoal) -> None:
        """The goal that is worked on shall end: it was cancelled, or a newer one waits."""

    def stopped(self) -> None:
        """The node has ended."""
        self.timer.cancel()

    # ------------------------------------------------------------------------------------------------- what it hears of

    def _goal(self, message: RosMessage) -> None:
        goal_id = message.goal_id
        if not goal_id.id:  # somebody typed it, without an id
            goal_id = goals.new_goal_id(self.node.name, goal_id.stamp or ros_time())
        if any(goal.id.id == goal_id.id for goal in self.goals):
            return  # it was sent twice
        goal = ServerGoal(goal_id, message.goal)
        self.goals.append(goal)
        if self._cancelled_before(goal_id):
            self.end(goal, RECALLED, None, CANCELLED_EARLY)
            return
        if self.next is not None:
            self.end(self.next, RECALLED, None, "A newer goal took its place.")
        self.next = goal
        if self.current is not None:
            self._ask_to_end(self.current)
        self.report()
        self.begin_wanted()

    def _cancelled_before(self, goal_id: RosMessage) -> bool:
        """Whether the request to cancel the goal overtook it, which is on another topic."""
        early = self.cancelled_ids.pop(goal_id.id, None) is not None
        return early or bool(goal_id.stamp) and goal_id.stamp <= self.cancelled_until

    def _cancel(self, message: RosMessage) -> None:
        everything = not message.id and not message.stamp
        if message.id and not any(goal.id.id == message.id for goal in self.goals):
            self.cancelled_ids[message.id] = kernel.now()
        self.cancelled_until = max(self.cancelled_until, message.stamp)
        for goal in list(self.goals):
            if everything or goal.id.id == message.id or message.stamp and goal.id.stamp <= message.stamp:
                if goal is self.next:
                    self.next = None
                    self.end(goal, RECALLED, None, CANCELLED_EARLY)
                elif goal is self.current:
                    self._ask_to_end(goal)

    def _ask_to_end(self, goal: ServerGoal) -> None:
        goal.cancelled = True
        if goal.state == ACTIVE:
            goal.state = PREEMPTING
            self.report()
        self.end_wanted(goal)

    # ------------------------------------------------------------------------------------------------------- what it does

    def accept(self) -> ServerGoal:
        """Take the goal that waits, which is ``current`` from now on; returns it."""
        goal = self.current = self.next
        self.next = None
        goal.state = ACTIVE
        self.report()
        return goal

    # ------------------------------------------------------------------------------------------------- what it tells

    def end(self, goal: ServerGoal, state: int, result: RosMessage | None, text: str = "") -> None:
        """Tell the clients that ``goal`` is over."""
        goal.state, goal.ended, goal.text = state, kernel.now(), text
        if self.node.alive:
            told = self.action.result() if result is None else result
            self.results.publish(self.action.action_result(header=_header(), status=_status(goal), result=told))
        self.report()

    def finish(self, goal: ServerGoal, state: int, result: RosMessage | None) -> None:
        """End ``goal`` in ``state`` with the result message (``None``: all defaults)."""
        if result is not None:
            goals.check_message(result, self.action.result)
        self.end(goal, state, result)

    def tell(self, goal: ServerGoal, feedback: RosMessage | None) -> int:
        """Send the feedback message about ``goal`` (``None``: all defaults)."""
        feedback = self.action.feedback() if feedback is None else goals.check_message(feedback, self.action.feedback)
        return self.feedbacks.publish(self.action.action_feedback(header=_header(), status=_status(goal), feedback=feedback))

    def report(self) -> None:
        """Tell the states of all goals, and forget those that ended long ago."""
        if not self.node.alive:
            return
        now, memory = kernel.now(), goals.setting("*GC-INTERVAL*", MEMORY)
        self.goals = [goal for goal in self.goals if goal.ended is None or now - goal.ended < memory]
        if self.cancelled_ids:
            self.cancelled_ids = {name: when for name, when in self.cancelled_ids.items() if now - when < memory}
        statuses = [_status(goal) for goal in self.goals]
        self.statuses.publish(message_class(goals.STATUS_ARRAY)(header=_header(), status_list=statuses))


def _header() -> RosMessage:
    return message_class("std_msgs/Header")(stamp=ros_time())


def _status(goal: ServerGoal) -> RosMessage:
    return message_class("actionlib_msgs/GoalStatus")(goal_id=goal.id, status=goal.state, text=ros_text(goal.text))
