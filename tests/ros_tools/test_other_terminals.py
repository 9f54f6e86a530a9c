"""The tools from another terminal: streams that Ctrl-C ends, programs that run in the session, and a session that goes away."""

from __future__ import annotations

import re
import socket
import struct
import threading
from contextlib import suppress
from dataclasses import replace

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.extras import install_command
from cramhy_runtime.ros_tools import running, remote_graph
from cramhy_runtime.ros_tools.graph_access import NoSession, Refused, SessionEnded


class Enough(KeyboardInterrupt):
    """Ctrl-C, when enough was printed."""


def stream(far_shell, words, lines):
    """What a command prints until it is interrupted, after so many pieces."""
    out = []

    def write(text):
        out.append(text)
        if len(out) >= lines:
            raise Enough

    status = far_shell.carry_out(lambda: running.run(words.split(), running.Terminal(write, out.append, remote_graph.current)))
    return "".join(out), status


def test_messages_are_printed_as_they_come_until_ctrl_c(far_shell):
    text, status = stream(far_shell, "rostopic echo /turtle1/color_sensor", 3)
    assert (text, status) == ("r: 69\ng: 86\nb: 255\n---\n" * 3, 0)


@pytest.mark.soak
def test_the_rate_of_a_topic_until_ctrl_c(far_shell):
    text, status = stream(far_shell, "rostopic hz /turtle1/pose", 2)
    assert status == 0 and re.fullmatch(
        r"subscribed to \[/turtle1/pose\]\n"
        r"average rate: \d+\.\d{3}\n\tmin: \d\.\d{3}s max: \d\.\d{3}s std dev: \d\.\d{5}s window: \d+\n",
        text,
    )


@pytest.mark.soak
def test_the_bytes_of_a_topic_until_ctrl_c(far_shell):
    text, status = stream(far_shell, "rostopic bw /turtle1/pose", 2)
    assert status == 0 and re.fullmatch(
        r"subscribed to \[/turtle1/pose\]\naverage: 1\.\d\dKB/s\n\tmean: 0\.02KB min: 0\.02KB max: 0\.02KB window: \d+\n", text
    )


@pytest.mark.soak
def test_a_topic_that_nobody_publishes_on_yet_is_waited_for(far_shell):
    node = []

    def publish():
        from cramhy_runtime.ros import graph
        from cramhy_runtime.ros.messages import message_class_exact

        string = message_class_exact("std_msgs/String")
        node.append(graph.active().node("late"))
        node[0].advertise("/late", string, latch=True).send(string("here"))

    kernel.call_at(kernel.now() + 0.3, publish)
    far_shell("rostopic echo -n 1 /late")
    assert far_shell.said == ('data: "here"\n---\n', "WARNING: topic [/late] does not appear to be published yet\n", 0)


@pytest.mark.soak
def test_a_command_that_is_repeated_keeps_the_turtle_going(far_shell):
    said = []

    def carry_out():
        graph = remote_graph.current()

        class Impatient(remote_graph.ThereGraph):
            def sleep(self, seconds):
                said.append(seconds)
                if len(said) > 10:
                    raise KeyboardInterrupt
                super().sleep(seconds)

        graph.__class__ = Impatient
        words = ["rostopic", "pub", "-r", "20", "/turtle1/cmd_vel", "geometry_msgs/Twist", "{angular: {z: 1.0}}"]
        return running.run(words, running.Terminal(said.append, said.append, lambda: graph))

    assert far_shell.carry_out(carry_out) == 0
    kernel.sleep(0.1)
    assert far_shell.simulator.turtles["turtle1"].pose()[4] == 1.0


def test_numbers_that_json_does_not_have_arrive(far_shell):
    from cramhy_runtime.ros import graph
    from cramhy_runtime.ros.messages import message_class_exact
    from cramhy_runtime.ros.wire import as_float

    arrived = []
    graph.active().node("hears").subscribe("/numbers", message_class_exact("std_msgs/Float64MultiArray"), arrived.append)

    def publish():
        reached = remote_graph.current()
        with reached.talk("/numbers", "std_msgs/Float64MultiArray", False) as send:
            send({"data": [1.5, float("nan"), float("inf"), float("-inf")]})
            reached.nodes()  # an answer comes after what was sent before
        reached.close()

    far_shell.carry_out(publish)
    assert str(list(map(as_float, arrived[0].data))) == "[1.5, nan, inf, -inf]"


@pytest.mark.soak
def test_who_prints_more_slowly_than_a_plan_publishes_gets_the_newest_messages(far_shell):
    from cramhy_runtime.ros import graph
    from cramhy_runtime.ros.messages import message_class_exact

    string = message_class_exact("std_msgs/String")
    session = graph.active()
    publication = session.node("fast").advertise("/fast", string)
    filling = "x" * 2000  # more than the socket's own buffers hold
    last = remote_graph.QUEUE + 8000

    def burst():
        for number in range(last + 1):
            publication.send(string(f"{number} {filling}"))
        done.append(True)

    done = []

    def listen():
        reached = remote_graph.current()
        taken = []
        try:
            with reached.listen("/fast", "std_msgs/String") as listener:
                reached.nodes()  # an answer comes after what was asked before
                session.kernel.post(burst)
                other = remote_graph.current()
                while not done:
                    other.nodes()
                other.close()
                while not taken or taken[-1] != last:
                    taken.append(int(listener.take()[1]["data"].split()[0]))
        finally:
            reached.close()
        return taken

    taken = far_shell.carry_out(listen)
    assert taken == sorted(set(taken)) and remote_graph.QUEUE <= len(taken) <= last


def test_a_node_is_ended(far_shell):
    assert far_shell("rosnode kill /turtlesim") == "killing /turtlesim\nkilled\n"
    assert far_shell("rosnode list") == "/rosout\n"


def test_types_that_only_the_session_knows_are_asked_for(far_shell, tmp_path):
    from cramhy_runtime.ros import definition_files

    (tmp_path / "packages" / "hidden_msgs" / "srv").mkdir(parents=True)
    (tmp_path / "packages" / "hidden_msgs" / "srv" / "Odd.srv").write_text("geometry_msgs/Point[2] points\n---\nbool ok\n")
    definition_files.add_package_directory(tmp_path / "packages")
    try:
        from cramhy_runtime.ros import graph
        from cramhy_runtime.ros.messages import service_type_exact

        odd = service_type_exact("hidden_msgs/Odd")
        graph.active().node("odd").serve("/odd", odd, lambda request: odd.response(request.points[1].x == 3.0))
    finally:
        definition_files.forget_package_directory(tmp_path / "packages")
    assert far_shell("rosservice info /odd").endswith("Type: hidden_msgs/Odd\nArgs: points\n")
    far_shell(["rosservice", "call", "/odd", "[{x: 1}, {x: 3, y: 2}]"])
    assert far_shell.said == ("ok: True\n", "", 0)


# ------------------------------------------------------------------------------------------------------------- programs


@pytest.fixture
def graph(far_shell):
    """The session's graph as another terminal sees it; its methods are to be called by `far_shell.carry_out`."""
    made = far_shell.carry_out(remote_graph.current)
    yield made
    far_shell.carry_out(made.close)


def start(far_shell, graph, executable, *arguments):
    return far_shell.carry_out(
        lambda: graph.call("/cramhy/start_program", "", {"package": "turtlesim", "executable": executable, "arguments": list(arguments)})
    )


def test_a_program_runs_in_the_session_and_its_log_is_heard(far_shell, graph):
    with_log = graph.listen("/cramhy/program_log", "cramhy_msgs/ProgramLine")
    with with_log as log:
        assert start(far_shell, graph, "draw_square")["node"] == "/draw_square"
        _, line = far_shell.carry_out(log.take)
        while "New goal" not in line["line"]:
            _, line = far_shell.carry_out(log.take)
        assert line["node"] == "/draw_square" and line["line"].endswith("New goal [7.544445 5.544445, 0.000000]")
        far_shell.carry_out(lambda: graph.kill("/draw_square"))
        while not line["ended"]:
            _, line = far_shell.carry_out(log.take)
    assert "/draw_square" not in far_shell.carry_out(graph.nodes)


def test_a_program_ends_with_the_terminal_that_started_it_even_when_that_is_killed(far_shell, graph):
    terminal = far_shell.carry_out(remote_graph.current)
    with graph.listen("/cramhy/program_log", "cramhy_msgs/ProgramLine") as log:
        assert start(far_shell, terminal, "turtlesim_node")["there"]  # it only looks on
        for node in ("__name:=first", "__name:=second"):
            start(far_shell, terminal, "mimic", node, "input:=turtle1", "output:=nobody")
        start(far_shell, graph, "mimic", "__name:=third", "input:=turtle1", "output:=nobody")
        far_shell.carry_out(lambda: terminal.kill("/first"))
        terminal.socket.socket.shutdown(socket.SHUT_RDWR)
        ended = set()
        while len(ended) < 2:
            _, line = far_shell.carry_out(log.take)
            if line["ended"]:
                ended.add(line["node"])
    assert ended == {"/first", "/second"}
    assert [name for name in far_shell.carry_out(graph.nodes) if name != "/rosout"] == ["/third", "/turtlesim"]
    far_shell.carry_out(terminal.close)  # else the tests behind this one would still ask there


def test_the_simulator_that_runs_is_looked_at_and_another_is_started(far_shell, graph):
    first = start(far_shell, graph, "turtlesim_node")
    assert first["node"] == "/turtlesim" and first["there"] and first["lines"][0].endswith("Starting turtlesim with node name /turtlesim")
    second = start(far_shell, graph, "turtlesim_node", "__ns:=/left", "_background_r:=5")
    assert second["node"] == "/left/turtlesim" and not second["there"]
    assert far_shell("rosparam get /left/turtlesim/background_r") == "5\n"


def test_keys_of_another_terminal_drive_the_turtle(far_shell, graph):
    node = start(far_shell, graph, "turtle_teleop_key")["node"]

    def feed(keys):
        return far_shell.carry_out(lambda: graph.call("/cramhy/feed_program", "", {"node": node, "keys": list(keys)}))["alive"]

    assert feed(b"\x1b[D") is True
    kernel.sleep(0.1)
    assert far_shell.simulator.turtles["turtle1"].pose()[4] == 2.0
    assert feed(b"xq") is False and feed(b"A") is False


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("service", "request_data", "text"),
    [
        (
            "start_program",
            {"package": "turtlesim", "executable": "rm"},
            "cramhy has no executable turtlesim/rm; turtlesim has draw_square, mimic, turtle_teleop_key, turtlesim_node.",
        ),
        (
            "start_program",
            {"package": "os", "executable": "draw_square"},
            "cramhy has no executable os/draw_square. Packages with executables: joint_state_publisher, lynxmotion_al5d_description, "
            "robot_state_publisher, tf, tf2_ros, turtle_actionlib, turtle_tf, turtle_tf2, turtlesim.",
        ),
        ("feed_program", {"node": "/turtlesim", "keys": [65]}, "The program /turtlesim reads no keys."),
        ("end_node", {"node": "/nobody"}, "There is no node /nobody."),
        ("end_node", {"node": "/cramhy_programs"}, "There is no node /cramhy_programs."),
    ],
)
def test_what_a_session_does_not_do_for_another_terminal(far_shell, graph, service, request_data, text):
    with pytest.raises(Refused) as caught:
        far_shell.carry_out(lambda: graph.call(f"/cramhy/{service}", "", request_data))
    assert str(caught.value) == text


def test_a_name_that_is_none(far_shell, graph):
    with pytest.raises(Refused) as caught:
        start(far_shell, graph, "mimic", "__name:=a-b")
    assert str(caught.value).startswith("A node cannot be called /a-b.")


# ---------------------------------------------------------------------------------------------------- when it goes away


def test_a_session_that_ends_is_told(far_shell, graph):
    far_shell.server.close()
    with pytest.raises(SessionEnded) as caught:
        far_shell.carry_out(lambda: graph.sleep(5))
    assert str(caught.value) == "The session has ended."


def test_without_a_session(far_shell):
    far_shell.server.close()
    far_shell("rostopic list")
    assert far_shell.said == (
        "",
        "ERROR: Unable to communicate with master!\nNo session serves here. Start one with: roslisp_repl --serve "
        '(after eval "$(cramhy ros-shims)" plain roslisp_repl does it).\n',
        1,
    )


def test_without_the_extra(far_shell, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "websockets.sync.client", None)
    far_shell("rostopic list")
    assert far_shell.said == (
        "",
        "ERROR: Unable to communicate with master!\nA session serves here, but reaching it takes the Python "
        f"package websockets. Type: {install_command('web')}\n",
        1,
    )


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("token", ["a wrong token", "wrong", "", "a/b?c&d#e"])
def test_a_session_that_does_not_let_us_in(far_shell, token):
    port = far_shell.server.port
    with pytest.raises(NoSession) as caught:
        far_shell.carry_out(lambda: remote_graph.ThereGraph("127.0.0.1", port, token))
    assert str(caught.value) == (
        f"The session at 127.0.0.1:{port} does not let us in: This is not the token of this session, or no address of it."
    )


def test_a_session_that_is_full_says_so(far_shell, monkeypatch):
    server = far_shell.server
    monkeypatch.setattr(server, "limits", replace(server.limits, connections=0))
    far_shell("rosnode list")
    assert far_shell.errors.endswith(
        f"The session at 127.0.0.1:{server.port} does not let us in: 0 clients are connected; more are not allowed.\n"
    )


def test_nobody_listens_where_the_session_was(far_shell):
    with pytest.raises(NoSession) as caught:
        far_shell.carry_out(lambda: remote_graph.ThereGraph("127.0.0.1", 1, ""))
    assert str(caught.value).startswith("The session at 127.0.0.1:1 does not let us in:")


@pytest.fixture
def dying_port():
    """A port whose process is being killed: it accepts, and every connection is reset."""
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def reset():
            with suppress(OSError):
                while True:
                    connection, _ = listener.accept()
                    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                    connection.close()

        threading.Thread(target=reset, daemon=True).start()
        yield listener.getsockname()[1]
        listener.shutdown(socket.SHUT_RDWR)


def test_a_session_that_resets_the_connection_does_not_let_us_in(dying_port):
    with pytest.raises(NoSession) as caught:
        remote_graph.ThereGraph("127.0.0.1", dying_port, "")
    assert str(caught.value).startswith(f"The session at 127.0.0.1:{dying_port} does not let us in: ")


def test_a_session_that_dies_while_it_is_reached_is_no_session(dying_port, far_shell, monkeypatch):
    from cramhy_runtime.rosbridge import sessions

    (newest,) = sessions.living()
    looks = iter([[replace(newest, port=dying_port)], []])
    monkeypatch.setattr(sessions, "living", lambda: next(looks, []))
    with pytest.raises(NoSession) as caught:
        remote_graph.current()
    assert str(caught.value) == "", "as where none ever was, so that a program goes on here"


def test_of_two_sessions_the_newest_is_taken_and_named(far_shell, monkeypatch, capsys):
    from cramhy_runtime.rosbridge import sessions

    (newest,) = sessions.living()
    assert "/turtlesim" in far_shell("rosnode list") and capsys.readouterr().err == ""
    monkeypatch.setattr(sessions, "living", lambda: [newest, replace(newest, pid=1, started=1)])
    assert "/turtlesim" in far_shell("rosnode list")
    assert capsys.readouterr().err == f"; 2 sessions run here; this is the newest, process {newest.pid}.\n"


# ---------------------------------------------------------------------------------------- the turtle of the session stays


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("words", [(), ("__name:=turtlesim",), ("__ns:=/", "__name:=turtlesim")])
def test_whoever_starts_the_sessions_own_simulator_looks_on(far_shell, graph, words):
    before = far_shell.simulator
    terminal = far_shell.carry_out(remote_graph.current)
    assert start(far_shell, terminal, "turtlesim_node", *words)["there"]
    far_shell.carry_out(terminal.close)
    far_shell.carry_out(graph.nodes)  # an answer after the other terminal has gone
    assert before.alive and before.graph.nodes["/turtlesim"].program is before


@pytest.mark.parametrize("word", ["_background_r:=5", "turtle1/cmd_vel:=/left"])
def test_another_simulator_does_not_take_the_name_of_the_sessions_own(far_shell, graph, word):
    with pytest.raises(Refused) as caught:
        start(far_shell, graph, "turtlesim_node", word)
    assert str(caught.value) == (
        "/turtlesim is the session's own, and would end if another one took its name. Give yours another name: __name:=other. "
        "To look on at the session's, leave out the words after turtlesim_node."
    )
    assert far_shell.simulator.alive


def test_a_client_may_replace_what_a_client_has_started(far_shell, graph):
    far_shell.simulator.shutdown()
    assert not start(far_shell, graph, "turtlesim_node")["there"]
    first = far_shell.simulator.graph.nodes["/turtlesim"].program
    assert not start(far_shell, graph, "turtlesim_node", "_background_r:=5")["there"]
    assert not first.alive and far_shell("rosparam get /turtlesim/background_r") == "5\n"


def test_the_simulator_that_waits_for_the_first_node_is_the_sessions_own(far_shell, graph):
    from cramhy_runtime.turtlesim.node import start_with_first_node

    far_shell.simulator.shutdown()
    start_with_first_node()
    terminal = far_shell.carry_out(remote_graph.current)
    answer = start(far_shell, terminal, "turtlesim_node")
    assert answer["there"] and answer["lines"][0].endswith("Starting turtlesim with node name /turtlesim")
    far_shell.carry_out(terminal.close)
    assert "/turtlesim" in far_shell.carry_out(graph.nodes)


def test_words_that_are_no_names_are_refused(far_shell, graph):
    with pytest.raises(Refused) as caught:
        start(far_shell, graph, "turtlesim_node", ":=x")
    assert "the empty string is not a name in ROS." in str(caught.value)
