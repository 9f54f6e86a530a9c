"""The page of a tab as a client of its session, over a port: the operations of rosbridge. Any Python can do that."""

from __future__ import annotations

import json

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.browser.port import Port
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class


class Page:
    """What the page hears, and the turns of its event loop."""

    def __init__(self):
        self.heard, self.due = [], []
        self.port = Port(
            graph.active(), lambda text: self.heard.append(json.loads(text)), lambda seconds, call: self.due.append((seconds, call))
        )

    def say(self, **operation):
        self.port.receive(json.dumps(operation))
        self.turn()

    def turn(self):
        kernel.yield_()
        while self.due:
            self.due.pop(0)[1]()
            kernel.yield_()

    def take(self):
        taken, self.heard = self.heard, []
        return taken


@pytest.fixture
def page(session):
    made = Page()
    made.say(op="auth", token="of this tab", hidden=True)
    assert made.take() == []
    return made


def test_a_topic_that_the_page_subscribes_to_is_sent_in_the_next_turn_of_the_event_loop(page):
    page.say(op="subscribe", topic="/chatter", type="std_msgs/String")
    kind = message_class("std_msgs/String")
    publication = graph.active().node("talker").advertise("/chatter", kind)
    for number in range(3):
        publication.publish(kind(data=f"word {number}"))
    assert page.take() == [] and len(page.due) == 1
    page.turn()
    assert [(each["op"], each["msg"]["data"]) for each in page.take()] == [("publish", f"word {number}") for number in range(3)]


def test_a_ping_is_answered_at_once_whatever_the_plan_does(page):
    page.port.receive('{"op": "ping"}')
    assert page.take() == [{"op": "pong"}]


def test_what_is_no_operation_is_told_and_the_next_is_heard(page):
    page.port.receive("{")
    (told,) = page.take()
    assert (told["op"], told["level"]) == ("status", "error")
    page.say(op="call_service", service="/rosapi/topics", id="1")
    (answer,) = page.take()
    assert (answer["op"], answer["id"], answer["result"]) == ("service_response", "1", True)


def test_a_page_that_comes_again_begins_anew(page):
    page.say(op="subscribe", topic="/chatter", type="std_msgs/String")
    page.say(op="auth", token="of this tab", hidden=True)
    kind = message_class("std_msgs/String")
    graph.active().node("talker").advertise("/chatter", kind).publish(kind(data="a word"))
    page.turn()
    assert page.take() == []


def test_while_the_page_is_there_waiting_is_no_deadlock_and_the_end_of_the_kernel_ends_it(page):
    assert kernel.active().hears_outside
    kernel.stop()
    page.port.receive('{"op": "ping"}')
    assert page.take() == []
