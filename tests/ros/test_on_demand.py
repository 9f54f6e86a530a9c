"""What starts when somebody asks for a name below its own, and publications that learn of their listeners."""

import pytest

from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact

STRING = message_class_exact("std_msgs/String")


@pytest.fixture
def started(session):
    """The graph's list of what has been started: the node ``/arm`` with a service, when a name below ``/arm`` is asked for."""
    found, here = [], graph.active()

    def start():
        found.append(node := here.node("arm"))
        empty = service_type_exact("std_srvs/Empty")
        node.serve("/arm/reset", empty, lambda _: empty.response())

    here.on_demand["arm"] = start
    return found


def test_the_first_who_subscribes_starts_it_and_the_second_does_not(started, running):
    running.subscribe("/arm/state", STRING, print)
    running.subscribe("/arm/other", STRING, print)
    assert len(started) == 1


def test_who_publishes_or_asks_for_a_service_starts_it_too(started, running):
    running.advertise("/arm/command", STRING)
    assert len(started) == 1
    started.pop().shutdown()
    assert graph.active().service("/arm/reset") is not None and len(started) == 1


@pytest.mark.parametrize("name", ["/army/state", "/chatter", "/left/arm/state", "/"])
def test_other_names_start_nothing(started, running, name):
    running.subscribe(name, STRING, print)
    graph.active().service(name)
    assert not started


def test_a_node_of_that_name_is_left_alone(started, running):
    mine = graph.active().node("arm")
    running.subscribe("/arm/state", STRING, print)
    assert not started and mine.alive


def test_a_publication_learns_when_listeners_come_and_go(running):
    publication = graph.active().node("other").advertise("/words", STRING)
    seen = []
    publication.on_listeners = lambda: seen.append(publication.subscribers)
    first = running.subscribe("/words", STRING, print)
    running.subscribe("/words", STRING, print)
    running.unsubscribe(first)
    running.shutdown()
    assert seen == [1, 2, 1, 0]
