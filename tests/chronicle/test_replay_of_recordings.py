"""Replaying a recording: the same messages at the same times, slower, faster, step by step, and from any of its moments on."""

from __future__ import annotations

import pytest
from systems import ONE_BACKEND

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.chronicle import player as players
from cramhy_runtime.chronicle.recordings import RecordingError
from cramhy_runtime.chronicle.merge import TOPICS, State
from cramhy_runtime.repl.session import Session
from cramhy_runtime.ros import graph, services
from cramhy_runtime.ros.message_json import to_json
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact

pytest.importorskip("mcap")

PLAN = """(progn (roslisp:start-ros-node "driver")
  (defparameter *turn* (make-fluent :name "turn" :value 0))
  (let ((pub (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist")))
    (top-level
      (dotimes (i 6)
        (setf (value *turn*) i)
        (par (roslisp:publish pub (roslisp:make-message "geometry_msgs/Twist" (x linear) 2 (z angular) i)) (sleep 0.5)))
      (roslisp:call-service "/clear" 'std_srvs-srv:Empty)
      (sleep 1))))"""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """A recording of five seconds: a turtle, a plan, and a clear."""
    made = tmp_path_factory.mktemp("replay") / "x.mcap"
    session = Session(time="virtual", seed=1)
    session.package = "CRAM-USER"
    with chronicle.record(made):
        session.evaluate_text(PLAN)
    kernel.stop()
    return made


@pytest.fixture(scope="module")
def whole(path):
    return list(chronicle.read(path).messages())


@pytest.fixture(params=ONE_BACKEND)
def fresh(request):
    yield kernel.start(backend=request.param)
    chronicle.stop()
    kernel.stop()


class Audience:
    """Hears every topic of a replay, with the time at which it comes."""

    def __init__(self, player, path):
        self.player, self.heard = player, []
        player.board.wall = lambda: kernel.now() * 2  # so that no two moments of the replay are too near to each other
        player.board.next = -1.0
        node = graph.active().node("audience", hidden=True)
        for topic, kind in chronicle.read(path).topics.items():
            node.subscribe(
                topic, message_class_exact(kind), lambda message, topic=topic: self.heard.append((player.position, topic, to_json(message)))
            )

    def of(self, topic):
        return [message for _, heard, message in self.heard if heard == topic]

    def sums(self):
        return sums([(topic, message) for _, topic, message in self.heard])


def sums(messages):
    """What messages of ``/cramhy`` add up to, without their stamps; of the lines, which are thinned out, where they begin and end."""
    from cramhy_runtime.ros.message_json import from_json

    state = State()
    for topic, data in messages:
        kind = players.KINDS_BY_TOPIC.get(topic)
        if kind is not None:
            types = {"world": "World", "tasks": "TaskTree", "fluents": "Fluents", "modules": "ProcessModules"}
            state.add(kind, from_json(message_class_exact(f"cramhy_msgs/{types[kind]}"), data))
    found = {kind: to_json(message) for kind, message in state.messages().items()}
    for message in found.values():
        message.pop("stamp")
    strokes = found["world"].pop("strokes")
    found["ends"] = [(strokes[0]["x1"], strokes[0]["y1"]), (strokes[-1]["x2"], strokes[-1]["y2"])] if strokes else []
    return found


def until(whole, time):
    return sums([(topic, data) for seconds, topic, _, data in whole if seconds <= time])


def replayed(path, **options):
    made = chronicle.replay(path, **options)
    return made, Audience(made, path)


def test_every_message_comes_again_in_order(fresh, path, whole):
    player, audience = replayed(path)
    kernel.sleep(10)
    assert player.ended
    for topic in ("/turtle1/pose", "/turtle1/cmd_vel", "/rosout", "/turtle1/color_sensor"):
        assert audience.of(topic) == [data for _, heard, _, data in whole if heard == topic] != []
    assert audience.sums() == until(whole, 100)


def test_the_times_between_messages_are_those_of_the_recording(fresh, path):
    player, audience = replayed(path, speed=2)
    kernel.sleep(1)
    assert player.position == pytest.approx(2, abs=0.05) and not player.ended
    kernel.sleep(2)
    assert player.position == pytest.approx(player.recording.end)


def test_without_a_speed_it_comes_at_once(fresh, path, whole):
    player, audience = replayed(path, speed=None)
    kernel.sleep(0.2)
    assert player.ended and audience.sums() == until(whole, 100)


def call(name, kind, **request):
    answer = services.exchange(graph.active().services[name], service_type_exact(kind).request(**request))
    return answer.failure or answer.response


def test_pausing_stepping_and_going_on(fresh, path, whole):
    player, audience = replayed(path)
    kernel.sleep(2)
    answer = call("/cramhy/set_pace", "cramhy_msgs/SetPace", paused=True, speed=1.0)
    assert answer.pace.paused is True and answer.pace.recording == "x.mcap"
    before, position = len(audience.heard), player.position
    kernel.sleep(5)
    assert (len(audience.heard), player.position) == (before, position)
    call("/cramhy/step", "cramhy_msgs/Step", seconds=0.25)
    assert player.position == pytest.approx(position + 0.25) and player.paused
    assert audience.sums() == until(whole, player.position)
    call("/cramhy/set_pace", "cramhy_msgs/SetPace", paused=False, speed=1.0)
    kernel.sleep(10)
    assert player.ended and audience.sums() == until(whole, 100)


@pytest.mark.parametrize("distance", [7, 2000])
def test_going_to_a_time_shows_everything_as_it_was_then(fresh, path, whole, monkeypatch, distance):
    monkeypatch.setattr(players, "LANDMARK", distance)
    monkeypatch.setattr(players, "MOST_LANDMARKS", 16)
    player, audience = replayed(path)
    call("/cramhy/set_pace", "cramhy_msgs/SetPace", paused=True, speed=1.0)
    for time in (4.0, 1.2, 4.9, 2.0, 0.0, 3.0, 2.99):
        audience.heard.clear()
        answer = call("/cramhy/seek", "cramhy_msgs/Seek", stamp=time)
        assert player.position == answer.pace.stamp == time
        found, expected = audience.sums(), until(whole, time)
        for kind in expected:
            assert found[kind] == expected[kind], (time, kind)
        poses = [data for seconds, topic, _, data in whole if topic == "/turtle1/pose" and seconds <= time]
        assert audience.of("/turtle1/pose") == poses[-1:]
        assert all(message["complete"] for message in audience.of("/cramhy/world"))
        state = call("/cramhy/get_state", "cramhy_msgs/GetState")
        assert len(state.tasks.tasks) == len(expected["tasks"]["tasks"])
    assert len(player._landmarks) <= 16


def test_after_going_back_it_goes_on_from_there(fresh, path, whole):
    player, audience = replayed(path)
    kernel.sleep(10)
    assert player.ended
    player.seek(1.5)
    assert not player.ended
    kernel.sleep(1)
    assert player.position == pytest.approx(2.5, abs=0.05)
    kernel.sleep(10)
    assert audience.sums() == until(whole, 100)


def test_that_it_is_another_time_is_told_before_what_was_heard_last_then(fresh, path):
    """A page keeps of its log what comes after that."""
    player, audience = replayed(path)
    player.seek(2)
    told = [topic in TOPICS.values() for _, topic, _ in audience.heard]
    assert told[0] and not told[-1] and told == sorted(told, reverse=True)


def test_times_that_are_not_there_are_the_nearest_that_are(fresh, path):
    player, _ = replayed(path)
    player.seek(-5)
    assert player.position == player.recording.begin
    player.seek(1e9)
    assert player.position == player.recording.end and player.ended


def test_the_board_tells_what_is_replayed(fresh, path):
    player, audience = replayed(path, speed=3)
    heard = []
    graph.active().node("late", hidden=True).subscribe("/cramhy/pace", message_class_exact("cramhy_msgs/Pace"), heard.append)
    kernel.sleep(0.1)
    pace = heard[-1]
    assert (pace.recording, pace.speed, pace.paused, pace.busy) == ("x.mcap", 3.0, False, True)
    assert (pace.begin, pace.end) == (player.recording.begin, player.recording.end)
    kernel.sleep(5)
    assert heard[-1].busy is False


def test_starting_to_tell_beside_a_replay_leaves_it_alone(fresh, path):
    player, _ = replayed(path)
    chronicle.start()
    assert graph.active().nodes["/cramhy"] is player.board.node
    chronicle.stop()
    assert graph.active().nodes["/cramhy"] is player.board.node


def test_closing_leaves_nothing(fresh, path):
    chronicle.replay(path).close()
    assert not graph.active().nodes and not graph.active().topics and players.there() is None


def test_another_replay_takes_the_place_of_the_first(fresh, path):
    first = chronicle.replay(path)
    second = chronicle.replay(path)
    assert players.there() is second and graph.active().nodes["/cramhy"] is second.board.node
    assert not first._timer.active


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "act, text",
    [
        (lambda player: player.seek(float("nan")), "The time to go to is not a number."),
        (lambda player: player.step(-1), "A step takes a time above zero, in seconds, but not -1."),
        (lambda player: player.set_pace(False, -2.0), "A speed is a number above zero, in recorded seconds per second, but not -2."),
    ],
)
def test_what_cannot_be_is_told(fresh, path, act, text):
    player, _ = replayed(path)
    with pytest.raises(ValueError) as problem:
        act(player)
    assert str(problem.value) == text
    kernel.sleep(10)
    assert player.ended


def test_of_a_cut_off_recording_the_rest_is_replayed_with_a_warning(fresh, path, tmp_path, capsys):
    cut = tmp_path / "cut.mcap"
    content = path.read_bytes()
    cut.write_bytes(content[: len(content) * 3 // 4])
    player, audience = replayed(cut)
    kernel.sleep(10)
    assert player.ended and audience.of("/turtle1/pose")
    assert "damaged or cut off" in capsys.readouterr().err


def test_a_topic_of_a_type_that_is_not_known_is_left_out_with_a_warning(fresh, tmp_path, capsys):
    from mcap.writer import Writer

    with open(tmp_path / "y.mcap", "wb") as file:
        writer = Writer(file)
        writer.start()
        for topic, kind in (("/things", "their_msgs/Thing"), ("/words", "std_msgs/String"), ("/numbers", "std_msgs/Int8")):
            channel = writer.register_channel(topic, "json", writer.register_schema(kind, "jsonschema", b"{}"))
            writer.add_message(channel, 10**9, b'{"data": "hello"}', 10**9)
        writer.finish()
    player, audience = replayed_of_known(tmp_path / "y.mcap")
    kernel.sleep(1)
    assert audience == ["hello"] and player.ended
    told = " ".join(capsys.readouterr().err.split())
    assert "/things is left out of the replay: its type their_msgs/Thing is not known here; is its package on ROS_PACKAGE_PATH?." in told
    assert "Messages on /numbers are left out of the replay: std_msgs/Int8 message requires a int8 for field data" in told


def replayed_of_known(path):
    heard = []
    made = chronicle.replay(path)
    graph.active().node("audience", hidden=True).subscribe(
        "/words", message_class_exact("std_msgs/String"), lambda message: heard.append(message.data)
    )
    return made, heard


def test_a_session_that_is_watched_itself_is_no_place_for_a_replay(fresh, path):
    chronicle.start()
    with pytest.raises(RecordingError) as problem:
        chronicle.replay(path)
    assert str(problem.value) == (
        f"{path} cannot be replayed in a session that is watched or recorded itself. Use a session of its own: cramhy replay {path}"
    )


def test_without_a_session_there_is_no_replay(path):
    with kernel.aside(), pytest.raises(RecordingError) as problem:
        chronicle.replay(path)
    assert str(problem.value) == (f"Nothing can be replayed from {path}: no session runs. Start one first, by the REPL or kernel.start().")


def test_all_topics_of_a_session_are_told(whole):
    assert set(TOPICS.values()) - {"/cramhy/process_modules", "/cramhy/robot_world"} <= {topic for _, topic, _, _ in whole}
