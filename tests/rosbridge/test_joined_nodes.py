"""The nodes of processes that joined a session are nodes there: with their names, their ends and their process, until they go.

The expected answers are those that ROS 1 gives for a talker and a listener in two terminals at one master (wiki.ros.org/rosnode, rostopic).
"""

from __future__ import annotations

import subprocess
import sys
from itertools import takewhile

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros_tools import local_graph, running

CHATTER = {"/chatter": "std_msgs/String"}


def node(pid=11, publications=(), subscriptions=()):
    return {"pid": pid, "publications": dict(publications), "subscriptions": dict(subscriptions)}


TALKER = {"/talker": node(11, publications={**CHATTER, "/rosout": "rosgraph_msgs/Log"})}
LISTENER = {"/tin/listener": node(12, subscriptions=CHATTER)}


@pytest.fixture
def said():
    """A function that runs a ROS command at the prompt of the session and gives the lines that it prints."""

    def run(line):
        texts = []
        running.run(line.split(), running.Terminal(texts.append, texts.append, lambda: local_graph.HereGraph(1.0)))
        return "".join(texts).splitlines()

    return run


@pytest.fixture
def chat(talk, other):
    """A talker and a listener, each in a process that has joined."""
    assert talk.say(op="nodes", nodes=TALKER) == []
    assert talk.say(op="advertise", topic="/chatter", type="std_msgs/String") == []
    assert other.say(op="nodes", nodes=LISTENER) == []
    assert other.say(op="subscribe", topic="/chatter", type="std_msgs/String") == []
    return talk, other


def test_each_process_has_its_own_node(chat, said):
    assert said("rosnode list") == ["/rosout", "/talker", "/tin/listener", "/turtlesim"]


def test_a_topic_knows_its_nodes(chat, said):
    lines = said("rostopic info /chatter")
    assert [line.split(" (")[0] for line in lines if line] == [
        "Type: std_msgs/String", "Publishers: ", " * /talker", "Subscribers: ", " * /tin/listener",
    ]  # fmt: skip


def test_a_node_knows_its_topics_and_its_process(chat, said):
    lines = said("rosnode info /talker")
    assert lines[1:5] == ["Node [/talker]", "Publications: ", " * /chatter [std_msgs/String]", " * /rosout [rosgraph_msgs/Log]"]
    assert "Pid: 11" in lines and "    * to: /tin/listener" in lines and "    * transport: ROSBRIDGE" in lines
    assert "Pid: 12" in said("rosnode info /tin/listener")


def test_each_message_arrives_once(chat):
    talk, other = chat
    talk.say(op="publish", topic="/chatter", msg={"data": "foo"})
    assert [each["msg"] for each in other.heard()] == [{"data": "foo"}]


def test_a_service_is_its_nodes(chat, said):
    talk, _ = chat
    talk.say(op="advertise_service", service="/talker/hush", type="std_srvs/Empty", node="/talker")
    assert said("rosservice node /talker/hush") == ["/talker"]
    assert " * /talker/hush" in said("rosnode info /talker")


def test_a_node_goes_with_its_process(chat, said):
    talk, _ = chat
    talk.session.close()
    assert said("rosnode list") == ["/rosout", "/tin/listener", "/turtlesim"]
    assert "Publishers: None" in said("rostopic info /chatter")


def test_what_a_process_tells_later_takes_the_place_of_what_it_told(chat, said):
    talk, _ = chat
    talk.say(op="nodes", nodes={"/talker": node(11), "/second": node(11, subscriptions=CHATTER)})
    assert said("rosnode list") == ["/rosout", "/second", "/talker", "/tin/listener", "/turtlesim"]
    assert "Publishers: None" in said("rostopic info /chatter") and " * /second" in "\n".join(said("rostopic info /chatter"))
    talk.say(op="nodes", nodes={})
    assert said("rosnode list") == ["/rosout", "/tin/listener", "/turtlesim"]


def test_two_nodes_of_one_process_share_a_topic(talk, other, said):
    talk.say(op="nodes", nodes={"/a": node(11, CHATTER), "/b": node(11, CHATTER)})
    talk.say(op="advertise", topic="/chatter", type="std_msgs/String")
    other.say(op="subscribe", topic="/chatter")
    talk.say(op="publish", topic="/chatter", msg={"data": "foo"})
    assert [each["msg"] for each in other.heard()] == [{"data": "foo"}]
    shown = "\n".join(said("rostopic info /chatter"))
    assert " * /a" in shown and " * /b" in shown


def test_rosnode_kill_tells_the_process(chat, said):
    talk, _ = chat
    assert said("rosnode kill /talker") == ["killing /talker", "killed"]
    kernel.yield_()
    assert talk.heard() == [{"op": "end_node", "node": "/talker", "reason": "user request"}]
    talk.say(op="nodes", nodes=TALKER)  # it was under way
    assert "/talker" not in said("rosnode list")
    talk.say(op="nodes", nodes={})
    talk.say(op="nodes", nodes=TALKER)
    assert "/talker" in said("rosnode list")


def test_a_second_node_of_the_name_ends_the_first(chat, said):
    """As ROS does it: "new node registered with same name"."""
    talk, other = chat
    other.say(op="nodes", nodes={**LISTENER, "/talker": node(12)})
    kernel.yield_()
    assert talk.heard() == [{"op": "end_node", "node": "/talker", "reason": "new node registered with same name"}]
    assert "Pid: 12" in said("rosnode info /talker")
    talk.session.close()
    assert "/talker" in said("rosnode list")


@pytest.mark.parametrize(
    ("nodes", "text"),
    [
        ([], '"nodes" must be an object, with a name of a node for each key, but it is an array.'),
        ({"/a": 3}, 'The node /a must be an object with "pid", "publications" and "subscriptions", but it is 3.'),
        ({"/a": {"publications": ["/x"]}}, '"publications" of the node /a must be an object from topics to types, but it is an array.'),
        ({"/a": {"pid": "x"}}, "\"pid\" must be a whole number from 0 on, but it is 'x'."),
        ({"a b": node()}, "/a b is not a name of a node: "),
        ({"/own": node()}, "The name /own is taken by the session itself."),
        ({f"/n{i}": node() for i in range(60)}, "You have 60 nodes; 50 are allowed."),
    ],
)
def test_what_cannot_be_a_node_is_refused(talk, graph, said, nodes, text):
    graph.node("own", hidden=True)
    found = talk.say(op="nodes", nodes=nodes)
    assert len(found) == 1 and found[0]["level"] == "error" and found[0]["msg"].startswith(text)
    assert said("rosnode list") == ["/rosout", "/turtlesim"]


def test_nodes_come_before_topics(talk):
    talk.say(op="advertise", topic="/chatter", type="std_msgs/String")
    assert talk.say(op="nodes", nodes={})[0]["msg"] == "Tell your nodes before you advertise, subscribe to and offer anything."


PEER = """
import json, os, sys
from cramhy_runtime import kernel, rosbridge
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.session import boot

kernel.start(clock="wall")
boot()
link = rosbridge.attach(sys.argv[1])
node = graph.active().node("/talker")
node.advertise("/chatter", message_class_exact("std_msgs/String"))
link.look()
link.ask("/rosapi/get_time")
print(os.getpid(), flush=True)
kernel.run_blocking(sys.stdin.readline)
from cramhy_runtime.repl.commands import run_line
for line in ("rosnode list", "rostopic info /chatter", "rosnode info /turtlesim", "rosnode kill /talker"):
    run_line(line, lambda text: print(text, end="", flush=True))
link.look()
link.ask("/rosapi/get_time")  # answers come in the order of questions: by now the session knows
print("done", flush=True)
kernel.run_blocking(sys.stdin.readline)
"""


@pytest.mark.soak
def test_a_process_that_is_killed_leaves_no_node(serve, said, outside):
    """The other process sees ours, its node is ours, ends by `rosnode kill`, and goes when the process is killed."""
    pytest.importorskip("roslibpy")
    server = serve("wall")
    peer = subprocess.Popen([sys.executable, "-c", PEER, server.address], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        pid = int(outside(peer.stdout.readline))
        assert "/talker" in said("rosnode list") and f"Pid: {pid}" in said("rosnode info /talker")
        peer.stdin.write("\n")
        peer.stdin.flush()
        lines = outside(lambda: list(takewhile(lambda line: line not in ("done\n", ""), peer.stdout)))
        text = "".join(lines)
        assert text.startswith("/rosout\n/talker\n/turtlesim\n") and "Type: std_msgs/String\n\nPublishers: \n * /talker" in text
        assert "Node [/turtlesim]" in text and text.endswith("killing /talker\nkilled\n")
        assert "/talker" not in said("rosnode list")
    finally:
        peer.kill()
        peer.wait()
