"""Reading recordings, whole ones, cut off ones, damaged ones and foreign ones: a recording or the declared error, nothing else."""

from __future__ import annotations

import io
import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from systems import SOAK

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.chronicle import recorder
from cramhy_runtime.chronicle.recordings import RecordingError

pytest.importorskip("mcap")

PLAN = """(progn (roslisp:start-ros-node "n")
  (top-level (dotimes (i 30) (par (sleep 0.1) (roslisp:ros-info (test) "step ~a" i)))))"""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """The bytes of a recording of several chunks."""
    from cramhy_runtime.repl.session import Session

    path, chunk = tmp_path_factory.mktemp("recorded") / "x.mcap", recorder.CHUNK
    recorder.CHUNK = 6000
    try:
        session = Session(time="virtual", seed=1)
        session.package = "CRAM-USER"
        with chronicle.record(path):
            session.evaluate_text(PLAN)
    finally:
        kernel.stop()
        recorder.CHUNK = chunk
    return path.read_bytes()


@pytest.fixture(scope="module")
def whole(recorded, tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "x.mcap"
    path.write_bytes(recorded)
    return list(chronicle.read(path).messages())


def chunks_of(content):
    """(end of the chunk in the file, messages in it) of each chunk."""
    from mcap.reader import make_reader

    summary = make_reader(io.BytesIO(content)).get_summary()
    return [(index.chunk_start_offset + index.chunk_length, index) for index in summary.chunk_indexes]


def read_bytes(folder, content):
    path = folder / "y.mcap"
    path.write_bytes(content)
    return chronicle.read(path)


def test_a_whole_recording_is_read_in_order(recorded, whole, tmp_path):
    found = read_bytes(tmp_path, recorded)
    assert found.cut == "" and found.skipped == {} and len(chunks_of(recorded)) >= 5
    assert found.count >= len(whole) > 100  # a scene for Foxglove is in the file, but nothing to be read here
    times = [seconds for seconds, *_ in whole]
    assert times == sorted(times) and (found.begin, found.end) == (times[0], times[-1])
    assert found.topics["/cramhy/tasks"] == "cramhy_msgs/TaskTree"
    numbered = list(found.numbered())
    assert [tuple(message) for _, *message in numbered] == whole
    for after in (0, 1, 37, 100, found.count):
        assert list(found.numbered(after)) == [message for message in numbered if message[0] > after]


@pytest.mark.soak
@given(data=st.data())
@settings(max_examples=150 if SOAK else 50, deadline=None, suppress_health_check=list(HealthCheck))
def test_a_file_cut_off_at_any_byte_is_read_as_far_as_whole_chunks_go(recorded, whole, tmp_path_factory, data):
    end = data.draw(st.integers(0, len(recorded) - 1))
    folder = tmp_path_factory.getbasetemp()
    complete = [index for finished, index in chunks_of(recorded) if finished <= end]
    try:
        found = read_bytes(folder, recorded[:end])
    except RecordingError as problem:
        assert not complete
        assert str(problem).startswith(str(folder / "y.mcap"))
        return
    messages = list(found.messages())
    assert messages == whole[: len(messages)]
    if complete:
        last = complete[-1].message_end_time / 1e9 - 1292688669.674
        assert len(messages) >= len([message for message in whole if message[0] < last - 1e-3])
    if len(messages) < len(whole):
        assert "cut off" in found.cut


@pytest.mark.soak
def test_a_small_file_cut_off_at_every_byte_is_readable_up_to_there(tmp_path):
    from cramhy_runtime.repl.session import Session

    session = Session(time="virtual", seed=1, turtlesim=False)
    session.package = "CRAM-USER"
    with chronicle.record(tmp_path / "x.mcap"):
        session.evaluate_text("(top-level (sleep 1))")
    content = (tmp_path / "x.mcap").read_bytes()
    all_of_them = list(chronicle.read(tmp_path / "x.mcap").messages())
    finished, counts = [end for end, _ in chunks_of(content)], []
    assert all_of_them and finished
    for end in range(len(content)):
        try:
            found = read_bytes(tmp_path, content[:end])
        except RecordingError as problem:
            assert str(problem).startswith(str(tmp_path / "y.mcap")) and "\n" not in str(problem) and not counts
        else:
            counts.append(len(list(found.messages())))
            assert bool(found.cut) or counts[-1] == len(all_of_them)
            assert counts[-1] == (len(all_of_them) if end >= finished[-1] else 0) or len(finished) > 1
    assert counts == sorted(counts) and counts[-1] == len(all_of_them)


@pytest.mark.soak
@given(data=st.data())
@settings(max_examples=150 if SOAK else 50, deadline=None, suppress_health_check=list(HealthCheck))
def test_damaged_bytes_are_a_recording_or_the_declared_error(recorded, tmp_path_factory, data):
    content = bytearray(recorded)
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    try:
        list(read_bytes(tmp_path_factory.getbasetemp(), bytes(content)).messages())
    except RecordingError:
        pass


@given(junk=st.binary(max_size=200))
@settings(max_examples=100 if SOAK else 50, deadline=None, suppress_health_check=list(HealthCheck))
def test_any_bytes_behind_the_magic_ones_are_the_declared_error_or_a_recording(tmp_path_factory, junk):
    with pytest.raises(RecordingError):
        read_bytes(tmp_path_factory.getbasetemp(), b"\x89MCAP0\r\n" + junk)


NO_MCAP = "{0} is no recording: it does not begin as files of the format MCAP do. What cramhy records with --record x.mcap can be replayed."


@pytest.mark.parametrize(
    "content, text",
    [
        (b"", NO_MCAP),
        (b"#ROSBAG V2.0\n", NO_MCAP),
        (b"\x89MCAP0\r\n", "{0} is no recording that could be read: it is cut off before its first message."),
    ],
)
def test_what_is_no_recording_is_told(tmp_path, content, text):
    with pytest.raises(RecordingError) as problem:
        read_bytes(tmp_path, content)
    assert str(problem.value) == text.format(tmp_path / "y.mcap")


def test_a_file_that_is_not_there_is_told(tmp_path):
    with pytest.raises(RecordingError) as problem:
        chronicle.read(tmp_path / "gone.mcap")
    assert str(problem.value) == f"The recording {tmp_path / 'gone.mcap'} cannot be read: No such file or directory."


def foreign(encoding="json", schema="jsonschema", name="std_msgs/String", data=b'{"data": "hello"}', times=(5, 3), chunked=False):
    from mcap.writer import Writer

    out = io.BytesIO()
    writer = Writer(out, use_chunking=chunked)
    writer.start("", "somebody else")
    number = writer.register_schema(name, schema, b"{}") if name else 0
    channel = writer.register_channel("/words", encoding, number)
    for time in times:
        writer.add_message(channel, time * 10**9, data, time * 10**9)
    writer.finish()
    return out.getvalue()


@pytest.mark.parametrize("chunked", [False, True])
def test_a_recording_of_another_tool_is_read_in_the_order_of_its_times(tmp_path, chunked):
    found = read_bytes(tmp_path, foreign(chunked=chunked))
    assert list(found.messages()) == [(seconds, "/words", "std_msgs/String", {"data": "hello"}) for seconds in (0.0, 2.0)]
    assert found.about == {} and found.cut == ""


def test_messages_that_are_no_json_are_left_out(tmp_path):
    assert list(read_bytes(tmp_path, foreign(data=b"{never")).messages()) == []
    assert list(read_bytes(tmp_path, foreign(data=b"[" * 100_000)).messages()) == []


@pytest.mark.parametrize(
    "options, why",
    [
        ({"encoding": "ros1", "schema": "ros1msg"}, "its messages are encoded as ros1, not as JSON"),
        ({"name": ""}, "it does not say what type its messages have"),
    ],
)
def test_a_recording_of_messages_that_nobody_can_read_here_says_why(tmp_path, options, why):
    with pytest.raises(RecordingError) as problem:
        read_bytes(tmp_path, foreign(**options))
    assert str(problem.value) == f"{tmp_path / 'y.mcap'} cannot be replayed: of /words, {why}."


def test_the_times_are_those_of_the_plan(whole):
    stamps = [(seconds, data["stamp"]) for seconds, topic, _, data in whole if topic == "/cramhy/tasks"]
    assert stamps and all(abs(seconds - stamp) < 1e-6 for seconds, stamp in stamps)
    assert json.dumps(whole)
